// A crop in pixels of the original: whole numbers, within the photograph, at least 1 × 1.

const between = (value, low, high) => Math.min(Math.max(value, low), high);

/** The rectangle between two corners, given in pixels with fractions; edges snap to whole pixels. */
export function spanned(a, b, size) {
  const [left, right] = [a.x, b.x].map((x) => between(Math.round(x), 0, size.width)).sort((p, q) => p - q);
  const [top, bottom] = [a.y, b.y].map((y) => between(Math.round(y), 0, size.height)).sort((p, q) => p - q);
  const x = Math.min(left, size.width - 1);
  const y = Math.min(top, size.height - 1);
  return { x, y, width: Math.max(1, right - x), height: Math.max(1, bottom - y) };
}

export function moved(rectangle, dx, dy, size) {
  return {
    ...rectangle,
    x: between(Math.round(rectangle.x + dx), 0, size.width - rectangle.width),
    y: between(Math.round(rectangle.y + dy), 0, size.height - rectangle.height),
  };
}

/** Drag the edges named in `edges` ("n", "se" …) by dx, dy; they stop at the photograph's border and at the edge opposite. */
export function resized(rectangle, edges, dx, dy, size) {
  let { x: left, y: top } = rectangle;
  let right = left + rectangle.width;
  let bottom = top + rectangle.height;
  if (edges.includes("w")) left = between(Math.round(left + dx), 0, right - 1);
  if (edges.includes("e")) right = between(Math.round(right + dx), left + 1, size.width);
  if (edges.includes("n")) top = between(Math.round(top + dy), 0, bottom - 1);
  if (edges.includes("s")) bottom = between(Math.round(bottom + dy), top + 1, size.height);
  return { x: left, y: top, width: right - left, height: bottom - top };
}

/** Make numbers that were typed fit: what is too long shrinks to the photograph, and then moves to where it fits. */
export function fitted({ x, y, width, height }, size) {
  const [wide, high] = [between(width, 1, size.width), between(height, 1, size.height)];
  return { x: between(x, 0, size.width - wide), y: between(y, 0, size.height - high), width: wide, height: high };
}

export const same = (one, other) => ["x", "y", "width", "height"].every((side) => one[side] === other[side]);
