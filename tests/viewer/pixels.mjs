// Reads pixels of pictures, and reads places from texts.

// Returns the set of colors of a portable pixmap, each as one number.
export function shadesOf(ppm) {
  const count = Math.floor((ppm.length - 15) / 3);
  return new Set(Array.from({ length: count }, (_, i) => ppm.readUIntBE(15 + 3 * i, 3)));
}

// Returns the pixels of a portable pixmap.
export function image(ppm) {
  const [, w, h] = ppm.toString('latin1', 0, 40).match(/^P6\n(\d+) (\d+)\n255\n/).map(Number);
  const from = ppm.length - 3 * w * h;
  return { width: w, height: h, at: (x, y) => [...ppm.subarray(from + 3 * (y * w + x), from + 3 * (y * w + x) + 3)] };
}

// Returns the pixels of a picture at an address, which may be a data URL. The browser decodes the picture.
export async function decoded(page, href) {
  const [width, height, text] = await page.evaluate(async (href) => {
    const picture = new Image();
    picture.src = href;
    await picture.decode();
    const copy = document.createElement('canvas');
    [copy.width, copy.height] = [picture.width, picture.height];
    const pen = copy.getContext('2d');
    pen.drawImage(picture, 0, 0);
    const { data } = pen.getImageData(0, 0, copy.width, copy.height);
    let text = '';
    for (let i = 0; i < data.length; i += 4) text += String.fromCharCode(data[i], data[i + 1], data[i + 2]);
    return [copy.width, copy.height, btoa(text)];
  }, href);
  return image(Buffer.concat([Buffer.from(`P6\n${width} ${height}\n255\n`), Buffer.from(text, 'base64')]));
}

// Returns the latitude and longitude in a text such as "35.292 N, 97.561 W".
export function placeOf(text) {
  const [, latitude, north, longitude, east] = text.match(/(\d+\.\d+) ([NS]), (\d+\.\d+) ([EW])/);
  return [Number(latitude) * (north === 'S' ? -1 : 1), Number(longitude) * (east === 'W' ? -1 : 1)];
}
