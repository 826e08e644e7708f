// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
export interface Row {
  t: number;
  p: [number, number, number];
  q?: [number, number, number, number];
}

/** A nav_msgs/Path as CDR, written field by field with the alignment rules of CDR. */
export function pathBytes(rows: Row[], sec = 1_700_000_000, nanosec = 900_000_000): DataView {
  const view = new DataView(new ArrayBuffer(64 + 80 * rows.length));
  let at = 4;
  view.setUint32(0, 0x00010000);
  const align = (size: number): void => {
    at += (size - ((at - 4) % size)) % size;
  };
  const u32 = (value: number): void => {
    align(4);
    view.setUint32(at, value, true);
    at += 4;
  };
  const header = (t: number): void => {
    const total = nanosec + Math.round(t * 1e9);
    u32(sec + Math.floor(total / 1e9));
    u32(total % 1e9);
    u32(4);
    for (const letter of "map\0") view.setUint8(at++, letter.charCodeAt(0));
  };
  header(0);
  u32(rows.length);
  for (const { t, p, q = [0, 0, 0, 1] } of rows) {
    header(t);
    for (const value of [...p, ...q]) {
      align(8);
      view.setFloat64(at, value, true);
      at += 8;
    }
  }
  return new DataView(view.buffer, 0, at);
}
