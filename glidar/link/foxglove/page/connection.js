// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause

/** A client of the Foxglove WebSocket protocol that connects again after the connection is lost.
 * Source of the protocol: the repository foxglove/ws-protocol on GitHub. */
const SUBPROTOCOLS = ["foxglove.sdk.v1", "foxglove.websocket.v1"];
const FIRST_PAUSE_MS = 500;
const MAX_PAUSE_MS = 5000;
const MESSAGE = 1;
const TIME = 2;

export class Connection {
  #handlers;
  #socket = null;
  #pauseMs = FIRST_PAUSE_MS;
  #channels = new Map();
  #subscribed = new Map();
  #nextId = 1;

  /** handlers: onOpen, onLost(seconds), onInfo(info), onChannels(channels), onMessage(channel, timeNs,
   * bytes), onTime(timeNs), onStatus(level, text). */
  constructor(handlers) {
    this.#handlers = handlers;
    this.#open();
  }

  subscribe(channel) {
    const id = this.#nextId++;
    this.#subscribed.set(id, channel);
    this.#send({ op: "subscribe", subscriptions: [{ id, channelId: channel.id }] });
  }

  unsubscribe(channel) {
    for (const [id, other] of this.#subscribed) {
      if (other.id !== channel.id) continue;
      this.#subscribed.delete(id);
      this.#send({ op: "unsubscribe", subscriptionIds: [id] });
    }
  }

  #open() {
    const scheme = location.protocol === "https:" ? "wss:" : "ws:";
    this.#socket = new WebSocket(`${scheme}//${location.host}/`, SUBPROTOCOLS);
    this.#socket.binaryType = "arraybuffer";
    this.#socket.onopen = () => {
      this.#pauseMs = FIRST_PAUSE_MS;
      this.#handlers.onOpen();
    };
    this.#socket.onmessage = (event) => {
      if (typeof event.data === "string") this.#onText(JSON.parse(event.data));
      else this.#onBinary(event.data);
    };
    this.#socket.onclose = () => this.#retry();
  }

  #retry() {
    this.#channels.clear();
    this.#subscribed.clear();
    this.#handlers.onLost(this.#pauseMs / 1000);
    setTimeout(() => this.#open(), this.#pauseMs);
    this.#pauseMs = Math.min(2 * this.#pauseMs, MAX_PAUSE_MS);
  }

  #send(message) {
    if (this.#socket.readyState === WebSocket.OPEN) this.#socket.send(JSON.stringify(message));
  }

  #onText(message) {
    if (message.op === "serverInfo") this.#handlers.onInfo(message);
    if (message.op === "status") this.#handlers.onStatus(message.level, message.message);
    if (message.op === "advertise") {
      for (const channel of message.channels) this.#channels.set(channel.id, channel);
      this.#handlers.onChannels(message.channels);
    }
  }

  #onBinary(buffer) {
    const view = new DataView(buffer);
    const kind = view.getUint8(0);
    if (kind === TIME) this.#handlers.onTime(view.getBigUint64(1, true));
    if (kind !== MESSAGE) return;
    const channel = this.#subscribed.get(view.getUint32(1, true));
    if (channel === undefined) return;
    // a copy at a multiple of 8 bytes, so that typed arrays can view its numbers
    this.#handlers.onMessage(channel, view.getBigUint64(5, true), new Uint8Array(buffer.slice(13)));
  }
}
