// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause

/** Play, pause and step of a replay. */
export class Playback {
  #box = document.getElementById("playback");
  #play = document.getElementById("play");
  #step = document.getElementById("step");
  #report;
  #isPlaying = true;

  constructor(report) {
    this.#report = report;
    this.#play.addEventListener("click", () => this.toggle());
    this.#step.addEventListener("click", () => this.step());
  }

  offer(isOffered) { this.#box.hidden = !isOffered; }

  show(state) {
    this.#isPlaying = state.playing === true;
    this.#play.textContent = this.#isPlaying ? "Pause" : "Play";
    document.body.dataset.playing = String(this.#isPlaying);
  }

  toggle() { this.#send(this.#isPlaying ? "pause" : "play"); }
  step() { this.#send("step"); }

  async #send(command) {
    if (this.#box.hidden) return;
    try {
      const response = await fetch("/api/playback", {
        method: "POST",
        headers: { "Content-Type": "application/json" },
        body: JSON.stringify({ command }),
      });
      this.#report(response.ok ? "" : await response.text());
    } catch {
      this.#report("the command did not reach the server");
    }
  }
}
