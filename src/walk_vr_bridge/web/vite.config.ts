// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
import { defineConfig } from "vitest/config";

// The page ships inside the Python package. Everything is a file of its own: the content security policy allows
// neither inline scripts nor data URLs.
export default defineConfig({
  base: "./",
  build: {
    outDir: "../walk_vr_bridge/static",
    emptyOutDir: true,
    assetsInlineLimit: 0,
    modulePreload: { polyfill: false },
    target: "es2022",
    chunkSizeWarningLimit: 1200,
  },
  test: { include: ["test/**/*.test.ts"], environment: "node" },
});
