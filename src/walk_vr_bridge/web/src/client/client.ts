// SPDX-FileCopyrightText: The walkthrough planner's authors
// SPDX-License-Identifier: Apache-2.0
/** The page's one connection: gets in, listens, keeps the store up to date, and offers the actions. */

import { Actions, SEEK_TYPE } from "./actions";
import { askAdmission, clientSecret, socketUrl, useAddressToken } from "./admission";
import * as answers from "./answers";
import { EditDesk } from "./desk";
import { Files } from "./loader";
import { keypointsFromMarkers } from "./markers";
import { GROUPS, keepParameters, readParameters } from "./parameters";
import { rawBytes, readPath, readTour } from "./path";
import { keepSettings, storedSettings } from "./settings";
import { initialState, Store } from "./store";
import { BROWSER_CLOCK, Wire, type Clock, type SocketLike, type WireListener } from "./wire";
import { openInWorker } from "./worker_socket";

const CONNECTING = "Connecting …";
const ADMISSION_AGAIN_MS = 2000;
/** Others may change parameters too, and no topic says so. */
const PARAMETERS_AGAIN_MS = 15000;

export class Client implements WireListener {
  readonly store: Store;
  readonly actions: Actions;
  private readonly wire: Wire;
  private readonly desk: EditDesk;
  private readonly loader: Files;
  private namespace = "/walk";

  constructor(
    makeSocket: () => SocketLike,
    private readonly clock: Clock = BROWSER_CLOCK,
  ) {
    this.store = new Store(initialState(""));
    this.wire = new Wire(makeSocket, this, clock);
    this.desk = new EditDesk(this.store, (message) => this.wire.publish(this.name("keypoint_edits"), message), clock);
    this.loader = new Files(this.store);
    this.actions = new Actions(this.store, this.desk, this.wire, () => this.namespace, clock.now);
  }

  /** Gets in and connects; where a code is needed first, the phase is `pairing` until `start` is called again. */
  async start(): Promise<void> {
    this.store.patch("connection", { phase: "connecting", message: CONNECTING });
    const admission = await askAdmission().catch(() => null);
    if (!admission) {
      this.store.patch("connection", { phase: "waiting", message: "The bridge does not answer. Trying again …" });
      this.clock.setTimer(() => void this.start(), ADMISSION_AGAIN_MS);
      return;
    }
    if (admission.role === null) {
      this.store.patch("connection", { phase: "pairing", message: "Type the code that the bridge has printed." });
      return;
    }
    this.namespace = admission.namespace;
    this.store.patch("session", { role: admission.role });
    this.listen();
    this.loader.start();
    this.wire.start();
  }

  /** Tries at once instead of waiting for the next attempt. */
  retry(): void {
    this.wire.start();
  }

  stop(): void {
    this.loader.stop();
    this.wire.stop();
  }

  /** Hears what has come: called before a frame is made, so that it shows the newest. */
  look(): void {
    this.wire.look();
  }

  /** Calls a service of the graph by its relative name. @throws WireError. */
  ask(service: string, args: unknown = {}): Promise<unknown> {
    return this.wire.call(this.name(service), args);
  }

  /** Publishes an event of a study; false where there is no connection. */
  publishStudyEvent(message: unknown): boolean {
    return this.wire.publish(this.name("study_events"), message);
  }

  opening(): void {
    // Between two attempts the sentence stays: one that comes and goes cannot be read.
    const { phase, message } = this.store.state.connection;
    const again = phase === "waiting";
    this.store.patch("connection", { phase: "connecting", message: again ? message : CONNECTING, retryAtMs: 0 });
  }

  opened(): void {
    this.store.patch("connection", { phase: "connected", message: "Connected", retryAtMs: 0 });
    this.desk.reconnected();
    this.loader.start();
    void this.readAllParameters();
  }

  closed(code: number, reason: string, retryMs: number | null): void {
    if (retryMs === null) {
      void this.askForCode();
      this.store.patch("connection", {
        phase: "refused",
        message: reason || "The bridge ended the connection.",
        retryAtMs: 0,
      });
      return;
    }
    const why = code === 1013 ? "The bridge is full." : "The connection is lost.";
    const message = `${why} Nothing is lost: what you do is sent when it is back.`;
    this.store.patch("connection", { phase: "waiting", message, retryAtMs: this.clock.now() + retryMs });
  }

  /** Let in no more: the cookie may have run out, then a code helps. */
  private async askForCode(): Promise<void> {
    const admission = await askAdmission().catch(() => null);
    if (admission?.role === null) await this.start();
  }

  complained(sentence: string): void {
    this.desk.refuse(null, null, sentence);
  }

  private name(topic: string): string {
    return topic.startsWith("/") ? topic : `${this.namespace}/${topic}`;
  }

  private listen(): void {
    const { store, wire } = this;
    const on = (
      topic: string,
      type: string,
      handle: (message: unknown) => void,
      compression: "cbor" | "cbor-raw" = "cbor",
    ) => wire.subscribe(this.name(topic), { type, compression }, handle);
    on("keypoint_markers", "visualization_msgs/MarkerArray", (message) =>
      this.desk.view.receive(keypointsFromMarkers(message)),
    );
    on("path", "nav_msgs/Path", (message) => this.takePath(message), "cbor-raw");
    on("tour", "nav_msgs/Path", (message) => this.takeTour(message), "cbor-raw");
    on("edit_results", "diagnostic_msgs/DiagnosticStatus", (message) =>
      this.desk.answered(answers.editResult(message)),
    );
    on("playback", "std_msgs/String", (message) =>
      store.set("playback", answers.playbackState(message, this.clock.now())),
    );
    on("bridge/files", "std_msgs/String", (message) => this.loader.announced(answers.files(message)));
    on("bridge/session", "std_msgs/String", (message) => store.set("session", answers.session(message)));
    on("/diagnostics", "diagnostic_msgs/DiagnosticArray", (message) => this.takeStatuses(message));
    for (const topic of ["playback/seek", "playback/speed"]) wire.advertise(this.name(topic), SEEK_TYPE);
    wire.advertise(this.name("keypoint_edits"), "visualization_msgs/InteractiveMarkerFeedback");
    wire.advertise(this.name("study_events"), "diagnostic_msgs/DiagnosticArray");
  }

  private takePath(message: unknown): void {
    const { path } = this.store.state;
    try {
      readPath(rawBytes(message), path);
    } finally {
      this.store.touch("path");
    }
  }

  private takeTour(message: unknown): void {
    readTour(rawBytes(message), this.store.state.tour);
    this.store.touch("tour");
  }

  private takeStatuses(message: unknown): void {
    const { nodes } = this.store.state;
    const merged = answers.mergeStatuses(nodes, answers.nodeStatuses(message));
    if (merged !== nodes) this.store.set("nodes", merged);
  }

  private async readAllParameters(): Promise<void> {
    for (const node of Object.keys(GROUPS)) {
      // A node that is not there (yet) has no sliders; it is asked again.
      const parameters = await readParameters(this.wire, this.namespace, node).catch(() => null);
      if (parameters) keepParameters(this.store, node, parameters);
    }
    this.clock.clearTimer(this.parametersTimer);
    if (this.wire.open)
      this.parametersTimer = this.clock.setTimer(() => void this.readAllParameters(), PARAMETERS_AGAIN_MS);
  }

  private parametersTimer = 0;
}

/** The client of this browser tab, not connected yet: call `start`. */
export async function browserClient(): Promise<Client> {
  await useAddressToken(window.location, window.history);
  const secret = clientSecret(window.sessionStorage);
  const client = new Client(() => openInWorker(socketUrl(window.location, secret)));
  client.store.set("settings", storedSettings(window.localStorage));
  client.store.subscribe("settings", () => keepSettings(window.localStorage, client.store.state.settings));
  return client;
}
