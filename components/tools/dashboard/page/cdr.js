// Reads sensor_msgs/msg/Image in little-endian CDR.

/** Returns {width, height, rgb}: rgb is a Uint8Array of 3 bytes for each pixel. Throws RangeError if it is cut. */
export function readImage(view, from) {
  const begin = from + 4; // behind the encapsulation header
  let at = begin;
  const u32 = () => {
    at = begin + Math.ceil((at - begin) / 4) * 4;
    const value = view.getUint32(at, true);
    at += 4;
    return value;
  };
  const skipText = () => {
    const size = u32();
    at += size;
  };
  u32(); // seconds
  u32(); // nanoseconds
  skipText(); // frame
  const height = u32();
  const width = u32();
  skipText(); // encoding
  at += 1; // is_bigendian
  u32(); // step
  const size = u32();
  if (size !== width * height * 3 || at + size > view.byteLength) throw new RangeError("the image is cut");
  return { width, height, rgb: new Uint8Array(view.buffer, view.byteOffset + at, size) };
}
