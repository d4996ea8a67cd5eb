// Answers of the service, and in plain words why there is none: its own reason, or that something in front of it spoke
// in its place. Proxies answer with pages of their own, so nothing is taken for JSON before it has been read as such.

const BROKEN = "The connection broke: look whether you are online, and try again.";
const SLOW = "The service has not answered in time: wait a minute, and try again.";
const REPLACED =
  "Something between this browser and the service answered in its place, such as a network’s login page: reload the page, and try again.";
const CLOSED =
  "Something in front of the service wants a login, or does not let this through: reload the page, and try again.";
const AWAY = "The service cannot be reached at the moment: wait a minute, and try again.";
/** @type {Record<number, string>} */
const WORDS = {
  401: CLOSED,
  403: CLOSED,
  407: CLOSED,
  408: "It took too long to arrive: try again, with a smaller file or over a faster connection.",
  413: "This is too large for this server or the proxy in front of it: send a smaller file, or ask who runs the service to allow larger ones.",
  429: "These were too many requests at once: wait a minute, and try again.",
  502: AWAY,
  503: AWAY,
  504: AWAY,
  511: CLOSED,
};

/** Why a request has no answer. `status` is 0 where none came at all, and `final` says that asking again changes nothing. */
export class Refusal extends Error {
  /**
   * @param {string} message
   * @param {number} status
   * @param {boolean} final
   */
  constructor(message, status = 0, final = false) {
    super(message);
    this.status = status;
    this.final = final;
  }
}

/**
 * What is known of a request that failed; what is no refusal is a fault of ours, and raised again.
 *
 * @param {unknown} error
 * @returns {Refusal}
 */
export function refusalOf(error) {
  if (error instanceof Refusal) return error;
  throw error;
}

/**
 * The object that an answer holds; raises a `Refusal`.
 *
 * @param {number} status
 * @param {string} text
 * @returns {object}
 */
export function read(status, text) {
  /** @type {unknown} */
  let content = null;
  try {
    content = JSON.parse(text);
  } catch {
    // A page of something in between, or cut off.
  }
  if (!status) throw new Refusal(BROKEN);
  const record = typeof content === "object" ? content : null;
  if (status >= 200 && status < 300) {
    if (record === null) throw new Refusal(REPLACED, status);
    return record;
  }
  if (record && "detail" in record && typeof record.detail === "string") {
    throw new Refusal(record.detail, status, status < 500 && status !== 429); // our own problem+json
  }
  const unexplained = `The service, or a proxy in front of it, answered ${status} without a reason: wait a minute, and try again.`;
  throw new Refusal(WORDS[status] ?? unexplained, status);
}

/**
 * Ask as `fetch` does, for at most `patience` milliseconds; raises a `Refusal`, or what `signal` was aborted with.
 *
 * @param {string} address
 * @param {RequestInit & { patience?: number }} options
 */
export async function ask(address, { signal, patience = Infinity, ...options } = {}) {
  const giveUp = new AbortController();
  const stop = () => giveUp.abort();
  const timer = patience < Infinity ? setTimeout(stop, patience) : 0;
  signal?.addEventListener("abort", stop);
  try {
    const answer = await fetch(address, { ...options, signal: giveUp.signal });
    return read(answer.status, await answer.text());
  } catch (error) {
    if (error instanceof Refusal) throw error;
    signal?.throwIfAborted();
    throw new Refusal(giveUp.signal.aborted ? SLOW : BROKEN);
  } finally {
    clearTimeout(timer);
    signal?.removeEventListener("abort", stop);
  }
}
