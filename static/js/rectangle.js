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

/** Make numbers that were typed fit, keeping the one typed last (`kept`: "x", "y", "width" or "height"). */
export function fitted(rectangle, kept, size) {
  const [x, width] = fitAxis(rectangle.x, rectangle.width, kept === "x", size.width);
  const [y, height] = fitAxis(rectangle.y, rectangle.height, kept === "y", size.height);
  return { x, y, width, height };
}

function fitAxis(start, length, startKept, total) {
  if (startKept) {
    const from = between(start, 0, total - 1);
    return [from, between(length, 1, total - from)];
  }
  const long = between(length, 1, total);
  return [between(start, 0, total - long), long];
}
