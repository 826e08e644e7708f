// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
// A whole session with the npm package roslib: node roslib_session.mjs FOLDER_WITH_NODE_MODULES PORT
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
const folder = join(process.argv[2], "node_modules", "roslib");
const entry = JSON.parse(readFileSync(join(folder, "package.json"), "utf8")).module;
const { Ros, Topic, Service } = await import(pathToFileURL(join(folder, entry)));
const ros = new Ros({ url: `ws://localhost:${process.argv[3]}` });
const heard = { path: 0, cbor: 0 };
const until = (what, test) => new Promise((done, fail) => {
  const end = Date.now() + 30000;
  const look = () => { const found = test(); if (found) done(found); else if (Date.now() > end) fail(new Error(what)); else setTimeout(look, 20); };
  look();
});
await new Promise((done, fail) => { ros.on("connection", done); ros.on("error", fail); });
let markers = null, answer = null;
const sub = (name, type, on, more = {}) => new Topic({ ros, name: `/walk/${name}`, messageType: type, ...more }).subscribe(on);
sub("keypoint_markers", "visualization_msgs/MarkerArray", (m) => { markers = m.markers.filter((k) => k.ns === "keypoints" && k.action === 0); });
sub("path", "nav_msgs/Path", () => { heard.path += 1; });
sub("keypoints", "geometry_msgs/PoseArray", (m) => { heard.cbor = m.poses.length; }, { compression: "cbor" });
sub("edit_results", "diagnostic_msgs/DiagnosticStatus", (m) => { answer = Object.fromEntries(m.values.map((v) => [v.key, v.value])); });
await until("snapshot", () => markers && heard.path && heard.cbor);
const edits = new Topic({ ros, name: "/walk/keypoint_edits", messageType: "visualization_msgs/msg/InteractiveMarkerFeedback" });
const say = async (msg) => { const paths = heard.path; answer = null; edits.publish(msg); const got = await until("answer", () => answer);
  if (got.outcome === "accepted") await until("path", () => heard.path > paths); return got; };
const first = markers[0], count = markers.length;
const position = { ...first.pose.position, x: first.pose.position.x - 0.1 };
const moved = await say({ marker_name: String(first.id), event_type: 5, pose: { position } });
const inserted = await say({ event_type: 2, menu_entry_id: 1, pose: { position: { x: 10.5, y: 0.9, z: 1.6 } } });
await until("insert", () => markers.length === count + 1);
const deleted = await say({ event_type: 2, menu_entry_id: 2, marker_name: inserted.keypoint });
await until("delete", () => markers.length === count);
const undone = await new Promise((done, fail) => new Service({ ros, name: "/walk/undo", serviceType: "std_srvs/Trigger" }).callService({}, done, fail));
await until("undo", () => markers.length === count + 1);
console.log(JSON.stringify({ outcomes: [moved, inserted, deleted].map((o) => o.outcome), undone: undone.success, paths: heard.path }));
process.exit(0);
