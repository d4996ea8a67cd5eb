// Promises that nobody waits for are started here and nowhere else: where one fails, the browser hears of it as of any
// other error.

/** @param {() => Promise<unknown>} work */
export function start(work) {
  work().catch(reportError);
}
