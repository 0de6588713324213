// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause

/** Reads CDR of ROS 2 messages: encapsulation header of 4 bytes, values aligned to their size from
 * behind it, at most 8 (OMG DDSI-RTPS 2.3, 10.2; OMG CORBA 3.3, 9.3). Throws RangeError at the end of
 * the data. */
export class CdrReader {
  #view;
  #bytes;
  #offset = 4;
  #little;

  constructor(bytes) {
    this.#bytes = bytes;
    this.#view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
    const kind = this.#view.getUint16(0);
    if (kind > 1) throw new RangeError(`CDR encapsulation ${kind} is not supported`);
    this.#little = kind === 1;
  }

  #align(size) {
    this.#offset += (size - ((this.#offset - 4) % size)) % size;
    const start = this.#offset;
    this.#offset += size;
    return start;
  }

  bool() { return this.u8() !== 0; }
  u8() { return this.#view.getUint8(this.#align(1)); }
  u32() { return this.#view.getUint32(this.#align(4), this.#little); }
  i32() { return this.#view.getInt32(this.#align(4), this.#little); }
  f32() { return this.#view.getFloat32(this.#align(4), this.#little); }
  f64() { return this.#view.getFloat64(this.#align(8), this.#little); }

  string() {
    const size = this.u32();
    const bytes = this.#take(size);
    return new TextDecoder().decode(bytes.subarray(0, Math.max(size - 1, 0)));
  }

  /** A sequence of bytes, as a view of the message. */
  bytes() { return this.#take(this.u32()); }

  f64s(count) {
    const values = new Array(count);
    for (let i = 0; i < count; ++i) values[i] = this.f64();
    return values;
  }

  f32s(count) {
    const values = new Array(count);
    for (let i = 0; i < count; ++i) values[i] = this.f32();
    return values;
  }

  /** The number of elements of a sequence, of which each takes at least so many bytes. */
  count(minBytes) {
    const count = this.u32();
    if (count * minBytes > this.#bytes.byteLength - this.#offset) throw new RangeError(`a sequence of ${count} elements ends early`);
    return count;
  }

  #take(size) {
    if (size > this.#bytes.byteLength - this.#offset) throw new RangeError(`${size} bytes end early`);
    const bytes = this.#bytes.subarray(this.#offset, this.#offset + size);
    this.#offset += size;
    return bytes;
  }
}
