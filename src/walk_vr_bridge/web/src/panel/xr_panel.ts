// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
/** The panel in the headset: a sheet in the room with the model's picture, drawn anew only when it has changed. */

import {
  CanvasTexture,
  Group,
  LinearFilter,
  Mesh,
  MeshBasicMaterial,
  PlaneGeometry,
  SRGBColorSpace,
  type Vector2,
} from "three";
import type { Hand } from "../client/state";
import type { PanelPort, PanelPress } from "../xr/panelport";
import { layOut } from "./layout";
import { HEIGHT, slideAt, TABS_HEIGHT, WIDTH, zoneAt, type Layout, type Zone } from "./sheet";
import { font } from "./strokes";
import type { PanelModel } from "./model";
import { paint } from "./paint";

/** A press that moves farther than this over the sheet scrolls it instead [px of the texture]. */
const SCROLL_FROM_PX = 36;
/** How far full deflection of a stick scrolls in one call [px]. */
const STICK_PX = 26;
/**
 * What changes while no hand points at the sheet, as the tour's length does 90 times a second during a drag, is drawn once it
 * has been still for so long, at the latest after the second time [s]: drawing the sheet takes longer than a frame has.
 */
const STILL_S = 0.2;
const LATEST_S = 2;

interface Finger {
  /** The zone pressed; null: the sheet itself. */
  key: string | null;
  startY: number;
  startScroll: number;
  scrolling: boolean;
}

export class XrPanel implements PanelPort {
  readonly widthM = 0.5;
  readonly heightM = (this.widthM * HEIGHT) / WIDTH;
  readonly group = new Group();
  readonly mesh: Mesh<PlaneGeometry, MeshBasicMaterial>;
  /** How often it was drawn. */
  drawn = 0;
  private readonly canvas = document.createElement("canvas");
  private readonly pen: CanvasRenderingContext2D;
  private readonly texture: CanvasTexture;
  private layout: Layout;
  private scrollPx = 0;
  /** The model has changed since it was laid out; for how long nobody has drawn it, and nothing more has changed [s]. */
  private stale = false;
  private staleS = 0;
  private stillS = 0;
  private dirty = true;
  /** What was laid out last, as text: two alike are drawn once. */
  private picture = "";
  private readonly fingers = new Map<Hand, Finger>();
  private readonly at = new Map<Hand, string>();
  private readonly sliding = new Map<string, number>();

  constructor(private readonly model: PanelModel) {
    this.canvas.width = WIDTH;
    this.canvas.height = HEIGHT;
    this.pen = this.canvas.getContext("2d")!;
    this.texture = new CanvasTexture(this.canvas);
    this.texture.colorSpace = SRGBColorSpace;
    this.texture.generateMipmaps = true;
    this.texture.magFilter = LinearFilter;
    this.texture.anisotropy = 8;
    const material = new MeshBasicMaterial({ map: this.texture, transparent: true, toneMapped: false });
    this.mesh = new Mesh(new PlaneGeometry(this.widthM, this.heightM), material);
    this.mesh.renderOrder = 40;
    this.group.add(this.mesh);
    this.layout = this.laidOut();
    model.onChange(() => {
      this.stale = true;
      this.stillS = 0;
    });
  }

  point(hand: Hand, at: Vector2 | null): void {
    const key = at ? this.under(hand, at.x * WIDTH, at.y * HEIGHT) : "";
    if ((this.at.get(hand) ?? "") === key) return;
    this.at.set(hand, key);
    this.dirty = true;
  }

  /** Moves what the hand holds of the sheet; returns the key of the zone that it is at. */
  private under(hand: Hand, x: number, y: number): string {
    this.refresh();
    const finger = this.fingers.get(hand);
    if (finger) this.moveFinger(finger, x, y);
    return zoneAt(this.layout, x, y, this.scrollPx)?.key ?? "";
  }

  press(hand: Hand, at: Vector2): PanelPress {
    this.refresh();
    const [x, y] = [at.x * WIDTH, at.y * HEIGHT];
    const zone = zoneAt(this.layout, x, y, this.scrollPx);
    if (zone?.look === "drag") return "add";
    this.fingers.set(hand, { key: zone?.key ?? null, startY: y, startScroll: this.scrollPx, scrolling: false });
    if (zone?.slide) this.slide(zone, x, false);
    this.dirty = true;
    return "pressed";
  }

  release(hand: Hand, at: Vector2 | null): void {
    const finger = this.fingers.get(hand);
    this.fingers.delete(hand);
    this.dirty = true;
    const zone = finger && this.zone(finger.key);
    if (!finger || !zone || finger.scrolling) return;
    if (zone.slide) {
      const position = this.sliding.get(zone.key) ?? zone.position ?? 0;
      this.sliding.delete(zone.key);
      zone.slide(position, true);
    } else if (at && zoneAt(this.layout, at.x * WIDTH, at.y * HEIGHT, this.scrollPx)?.key === zone.key) {
      zone.press?.();
    }
  }

  /** @param amount -1 to 1, as a stick says; up is negative. */
  scroll(_hand: Hand, amount: number): void {
    this.scrollTo(this.scrollPx + amount * STICK_PX);
  }

  /** Once a frame. */
  update(seconds: number): void {
    if (!this.group.visible) return;
    this.stillS += seconds;
    this.staleS += seconds;
    if (this.stillS > STILL_S || this.staleS > LATEST_S) this.refresh();
    if (!this.dirty) return;
    this.dirty = false;
    const pressed = new Set([...this.fingers.values()].flatMap(({ key }) => key ?? []));
    paint(this.pen, this.layout, this.scrollPx, { hovered: new Set(this.at.values()), pressed, sliding: this.sliding });
    this.texture.needsUpdate = true;
    this.drawn += 1;
  }

  /** Where the zone of a widget is on the sheet, x right and y down, 0 to 1; null: not there, or scrolled away. */
  find(key: string): { x: number; y: number } | null {
    this.refresh();
    const zone = this.layout.zones.find((one) => one.key === key || one.key.endsWith(`/${key}`));
    if (!zone) return null;
    const y = zone.y + zone.h / 2 - (zone.look === "tab" ? 0 : this.scrollPx);
    const seen = zone.look === "tab" || (y > TABS_HEIGHT && y < HEIGHT);
    return seen ? { x: (zone.x + zone.w / 2) / WIDTH, y: y / HEIGHT } : null;
  }

  /** Lays the sheet out if the model has changed; it is drawn only if it looks different. */
  private refresh(): void {
    this.staleS = 0;
    if (!this.stale) return;
    this.stale = false;
    this.layout = this.laidOut();
    this.scrollTo(this.scrollPx);
    const picture = pictureOf(this.layout);
    this.dirty ||= picture !== this.picture;
    this.picture = picture;
  }

  private laidOut(): Layout {
    const open = (tab: PanelModel["tab"]): void => {
      this.scrollPx = 0;
      this.model.open(tab);
    };
    return layOut(this.model.tab, open, this.model.sections(), (text, size) => {
      this.pen.font = font(size, 500);
      return this.pen.measureText(text).width;
    });
  }

  private zone(key: string | null): Zone | null {
    return this.layout.zones.find((zone) => zone.key === key) ?? null;
  }

  private moveFinger(finger: Finger, x: number, y: number): void {
    const zone = this.zone(finger.key);
    if (zone?.slide) return this.slide(zone, x, true);
    finger.scrolling ||= Math.abs(y - finger.startY) > SCROLL_FROM_PX;
    if (finger.scrolling) this.scrollTo(finger.startScroll + finger.startY - y);
  }

  private slide(zone: Zone, x: number, tell: boolean): void {
    const position = slideAt(zone, x);
    if (this.sliding.get(zone.key) === position) return;
    this.sliding.set(zone.key, position);
    if (tell) zone.slide?.(position, false);
    this.dirty = true;
  }

  private scrollTo(y: number): void {
    const scroll = Math.max(0, Math.min(this.layout.bottom - HEIGHT, y));
    if (scroll === this.scrollPx) return;
    this.scrollPx = scroll;
    this.dirty = true;
  }
}

/** All that is seen of a layout: JSON leaves out what the zones do. */
function pictureOf({ zones, bottom }: Layout): string {
  return JSON.stringify([bottom, zones, zones.map(({ text, position }) => text?.(position ?? 0))]);
}
