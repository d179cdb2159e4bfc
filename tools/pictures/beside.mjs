import { PNG } from 'pngjs';

/** Pictures of the same height beside each other, so many pixels apart, as a .png's bytes. */
export function beside(pictures, gap) {
  const all = new PNG({
    width: pictures.reduce((width, picture) => width + picture.width + gap, -gap),
    height: pictures[0].height,
  });
  let left = 0;
  for (const picture of pictures) {
    PNG.bitblt(picture, all, 0, 0, picture.width, picture.height, left, 0);
    left += picture.width + gap;
  }
  return PNG.sync.write(all, { colorType: 2, filterType: 4, deflateStrategy: 0 });
}
