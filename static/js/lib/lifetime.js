// Lifetimes of what listens: whoever listens on the window or the document, or observes, takes the AbortSignal of the
// part of the page that it belongs to, and lets go once that part has been taken away.

/**
 * Let an observer observe an element until `signal` is aborted.
 *
 * @param {ResizeObserver | IntersectionObserver} observer
 * @param {Element} element
 * @param {AbortSignal} signal
 */
export function observe(observer, element, signal) {
  if (signal.aborted) return;
  observer.observe(element);
  signal.addEventListener("abort", () => observer.disconnect(), { once: true });
}
