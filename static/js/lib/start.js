// Work that nobody waits for is started here and nowhere else: where it fails, the browser hears of it as of any other error.

/** @param {() => Promise<unknown>} work */
export function start(work) {
  work().catch(reportError);
}
