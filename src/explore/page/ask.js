// The one way to the server. A host such as a notebook gives `mount` a function of its own in place of `fetched`.

/** An answer that is none: the server says what was wrong, or what it would cost. */
export class Refusal extends Error {
  constructor(status, { error, too_costly: tooCostly } = {}) {
    const said = error && [error.message, error.remedy].filter(Boolean).join("; ");
    super(said || (tooCostly ? "this would cost too much" : `the server answered ${status}`));
    Object.assign(this, { status, field: error?.field ?? null, tooCostly: tooCostly ?? null });
  }
}

/** Asks by GET, relative to the page. Resolves to {status, type, bytes: ArrayBuffer}. */
export async function fetched(path, params, signal) {
  const query = new URLSearchParams(params).toString();
  const reply = await fetch(query ? `${path}?${query}` : path, { signal });
  return { status: reply.status, type: reply.headers.get("content-type") ?? "", bytes: await reply.arrayBuffer() };
}

const pause = (ms, signal) =>
  new Promise((resolve, reject) => {
    const timer = setTimeout(resolve, ms);
    signal?.addEventListener("abort", () => (clearTimeout(timer), reject(signal.reason)), { once: true });
  });

const parsed = (bytes) => {
  try {
    return JSON.parse(new TextDecoder().decode(bytes));
  } catch {
    return {};
  }
};

/** The questions over an `ask`: bytes or JSON, errors as `Refusal`, a busy server asked again. */
export function questions(ask) {
  async function bytes(path, params, signal) {
    for (let wait = 100; ; wait = Math.min(2 * wait, 3000)) {
      const reply = await ask(path, params, signal);
      if (reply.status === 503) {
        await pause(wait, signal);
        continue;
      }
      if (reply.status !== 200) throw new Refusal(reply.status, parsed(reply.bytes));
      return reply;
    }
  }
  const json = async (path, params, signal) => parsed((await bytes(path, params, signal)).bytes);
  return { bytes, json };
}

/** Of several calls in a row only the last matters: each ends the one before, and begins after `delay`. */
export function latest(work, delay = 0) {
  let controller = null;
  const run = async (...values) => {
    controller?.abort();
    const mine = (controller = new AbortController());
    try {
      if (delay) await pause(delay, mine.signal);
      return await work(...values, mine.signal);
    } catch (error) {
      if (!mine.signal.aborted) throw error;
      return undefined;
    }
  };
  run.stop = () => controller?.abort();
  return run;
}
