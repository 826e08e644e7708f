// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
// Runs in the page before its own scripts: a headset that is not there, and hands that tests move. Places are those of the
// room in metres, as [x, y, z], unless they are called map.
(() => {
  // Before each frame the emulator asks the graphics system for three values. A question waits until the frame before has been
  // drawn, which no headset does, and in software that is most of the time: what the page hears then waits, too.
  const gl = WebGL2RenderingContext.prototype;
  const { getParameter } = gl;
  const values = new WeakMap();
  for (const [setter, name] of [["clearColor", 0x0c22], ["clearDepth", 0x0b73], ["clearStencil", 0x0b91]]) {
    const set = gl[setter];
    gl[setter] = function (...given) {
      if (!values.has(this)) values.set(this, new Map());
      values.get(this).set(name, given.length > 1 ? new Float32Array(given) : given[0]);
      return set.apply(this, given);
    };
  }
  gl.getParameter = function (name) {
    return values.get(this)?.get(name) ?? getParameter.call(this, name);
  };

  const device = new IWER.XRDevice(IWER.metaQuest3);
  device.installRuntime({ forceInstall: true });
  device.stereoEnabled = true;
  device.ipd = 0.063;
  const rig = () => walk.view.rig;

  const local = (room) => {
    rig().updateMatrixWorld();
    const at = walk.view.eye.clone().fromArray(room);
    return rig().worldToLocal(at);
  };
  const input = (side) => (device.primaryInputMode === "hand" ? device.hands[side] : device.controllers[side]);

  const hands = {
    device,
    /** Waits until the page has drawn some frames. */
    async frames(count) {
      const end = walk.view.frames + count;
      while (walk.view.frames < end) await new Promise((done) => setTimeout(done, 2));
    },
    /** Waits until something holds and returns it. */
    async until(condition, what, limitMs = 20000) {
      const end = performance.now() + limitMs;
      for (;;) {
        const value = await condition();
        if (value) return value;
        if (performance.now() > end) throw new Error(`waited in vain for ${what}`);
        await new Promise((done) => setTimeout(done, 5));
      }
    },
    async enter() {
      await hands.until(() => window.walk?.stage.models && walk.client.store.state.path.count, "building and path", 90000);
      await walk.xr.enter();
      await hands.until(() => walk.view.presenting, "the session");
      hands.head([0, 1.6, 0]);
      hands.put("left", [-0.3, 1.0, -0.1], [-0.3, 1.0, -1]);
      hands.put("right", [0.3, 1.0, -0.1], [0.3, 1.0, -1]);
      await hands.frames(4);
      walk.room.bringToHand();
      await hands.frames(2);
    },
    /**
     * Frames come as often as the display takes them, on a grid of its own: one that is late waits for the next place. Returns
     * how often that is, if not given as the session has it [Hz]. The emulator's own frames are the browser's, and go to the
     * page's canvas, which the browser then copies to the screen; in software the page hears nothing meanwhile. A headset draws
     * to displays of its own, so the canvas is taken from the screen.
     */
    pace(hz = walk.view.renderer.xr.getSession().frameRate) {
      document.querySelector("#view").style.visibility = "hidden";
      const began = performance.now();
      let last = 0;
      window.requestAnimationFrame = (callback) => {
        const now = performance.now();
        last = Math.max(last + 1, Math.ceil(((now - began) * hz) / 1000));
        return setTimeout(() => callback(performance.now()), began + (last * 1000) / hz - now);
      };
      window.cancelAnimationFrame = clearTimeout;
      return hz;
    },
    /** The head, in the headset's own space. */
    head(at, heading = 0) {
      device.position.set(...at);
      device.quaternion.set(0, Math.sin(heading / 2), 0, Math.cos(heading / 2));
    },
    /** A hand, in the headset's own space. */
    put(side, from, at) {
      turnTo(input(side), from, at);
    },
    /** A hand in the room that points from one place at another. */
    aim(side, from, at) {
      turnTo(input(side), local(from).toArray(), local(at).toArray());
    },
    /** A hand whose grabbing point is at a place of the room; it points as the head looks. */
    async reach(side, room) {
      for (let round = 0; round < 3; round++) {
        const hand = walk.room.inputs[side];
        const ahead = [room[0] + hand.ray.direction.x, room[1] + hand.ray.direction.y, room[2] + hand.ray.direction.z];
        const off = hand.tip.clone().sub(hand.ray.origin).toArray();
        const from = room.map((value, axis) => value - (round ? off[axis] : 0));
        hands.aim(side, from, round ? from.map((v, i) => v + ahead[i] - room[i]) : ahead);
        await hands.frames(2);
      }
    },
    async button(side, id, value) {
      const hand = input(side);
      if (device.primaryInputMode === "hand") hand.updatePinchValue(value);
      else hand.updateButtonValue(id, value);
      await hands.frames(3);
    },
    async click(side, id) {
      await hands.button(side, id, 1);
      await hands.button(side, id, 0);
    },
    async stick(side, x, y) {
      device.controllers[side].updateAxes("thumbstick", x, y);
      await hands.frames(3);
    },
    /** Where a keypoint is drawn in the room: in "miniature" or "full". */
    shown(id, where = "miniature") {
      const overlay = where === "full" ? walk.stage.inFull : walk.stage.inMiniature;
      const keypoint = hands.keypoint(id);
      return overlay.place.shown(keypoint.position, walk.view.eye.clone()).toArray();
    },
    keypoint: (id) => walk.client.store.state.keypoints.find((one) => one.id === id),
    /** Moves a hand that holds something to a place, in steps as a hand does. */
    async carry(side, from, to, steps = 6) {
      for (let step = 1; step <= steps; step++) {
        await hands.reachOnce(side, from.map((value, axis) => value + ((to[axis] - value) * step) / steps));
        await hands.frames(2);
      }
    },
    /** Keypoints that nobody planned, for tests of what is drawn. */
    invent(places) {
      const plain = { quat: [0, 0, 0, 1], label: "", locked: false, start: false, end: false, dwellS: null, lookAt: null };
      const made = places.map((position, id) => ({ ...plain, id, position, unreachable: "", pending: false }));
      walk.client.store.set("keypoints", made);
    },
    /** A hand that points at a widget of the panel from a forearm's distance. */
    async atPanel(side, widget) {
      const { panel } = walk.room;
      const spot = panel.find(widget);
      const at = walk.view.eye.clone().set((spot.x - 0.5) * panel.widthM, (0.5 - spot.y) * panel.heightM, 0);
      const room = panel.group.localToWorld(at).toArray();
      const eye = walk.view.eye.toArray();
      hands.aim(side, room.map((value, axis) => value + (eye[axis] - value) * 0.4), room);
      await hands.frames(3);
    },
    /** How far the head is from where the tour stands, on the floor. */
    offTour() {
      const at = walk.stage.player.position;
      return Math.hypot(at[0] - walk.view.eye.x, -at[1] - walk.view.eye.z);
    },
    /** Waits until the planner has answered everything. */
    answered: () => hands.until(() => walk.client.store.state.connection.unconfirmed === 0, "the answer"),
    /** Brings the grabbing point to a place without turning the hand. */
    async reachOnce(side, room) {
      const hand = walk.room.inputs[side];
      const off = hand.tip.clone().sub(hand.ray.origin);
      const from = room.map((value, axis) => value - off.getComponent(axis));
      input(side).position.set(...local(from).toArray());
    },
  };

  function turnTo(hand, from, at) {
    hand.position.set(...from);
    const [x, y, z] = at.map((value, axis) => value - from[axis]);
    const yaw = Math.atan2(-x, -z);
    const pitch = Math.atan2(y, Math.hypot(x, z));
    const [cy, sy, cp, sp] = [Math.cos(yaw / 2), Math.sin(yaw / 2), Math.cos(pitch / 2), Math.sin(pitch / 2)];
    hand.quaternion.set(cy * sp, sy * cp, -sy * sp, cy * cp);
  }
  window.hands = hands;
})();
