// The images of the camera and of perception.
import { readImage } from "./cdr.js";

/** Draws a message of the type sensor_msgs/msg/Image on a canvas, which gets the image's size. */
export function drawImage(canvas, view, from) {
  const { width, height, rgb } = readImage(view, from);
  if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, { width, height });
  const context = canvas.getContext("2d");
  const image = context.createImageData(width, height);
  const pixels = new Uint32Array(image.data.buffer); // four bytes at once: this is the longest loop of the page
  for (let i = 0, k = 0; i < rgb.length; i += 3, ++k)
    pixels[k] = 0xff000000 | (rgb[i + 2] << 16) | (rgb[i + 1] << 8) | rgb[i];
  context.putImageData(image, 0, 0);
}
