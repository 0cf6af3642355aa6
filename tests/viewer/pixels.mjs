// Reads pixels of pictures, and places of texts.

// The different colors of a portable pixmap, each as one number.
export function shadesOf(ppm) {
  const count = Math.floor((ppm.length - 15) / 3);
  return new Set(Array.from({ length: count }, (_, i) => ppm.readUIntBE(15 + 3 * i, 3)));
}

// A portable pixmap as pixels.
export function image(ppm) {
  const [, w, h] = ppm.toString('latin1', 0, 40).match(/^P6\n(\d+) (\d+)\n255\n/).map(Number);
  const from = ppm.length - 3 * w * h;
  return { width: w, height: h, at: (x, y) => [...ppm.subarray(from + 3 * (y * w + x), from + 3 * (y * w + x) + 3)] };
}

// Latitude and longitude of a text that says them as the page does: "35.292 N, 97.561 W".
export function placeOf(text) {
  const [, latitude, north, longitude, east] = text.match(/(\d+\.\d+) ([NS]), (\d+\.\d+) ([EW])/);
  return [Number(latitude) * (north === 'S' ? -1 : 1), Number(longitude) * (east === 'W' ? -1 : 1)];
}
