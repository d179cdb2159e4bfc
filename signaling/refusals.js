/** Milliseconds for which refusals of one reason are gathered into one line of the log. */
const gatherMs = 5000;

/**
 * Counts what is refused and says so: the first of a reason at once, the rest of the next seconds together, so that
 * nobody fills the log.
 * @param {import('./metrics.js').Metrics} metrics
 * @param {(line: string) => void} log
 */
export function createRefusals(metrics, log) {
  /** @type {Map<string, {count: number, visitor: string}>} */
  const gathered = new Map();
  /**
   * @param {string} reason  for /metrics
   * @param {string} visitor  who was refused
   * @param {string} [text]  for people
   */
  return (reason, visitor, text = reason) => {
    metrics.refusedConnections.inc({ reason });
    const more = gathered.get(reason);
    if (more) {
      more.count += 1;
      more.visitor = visitor;
      return;
    }
    log(`refused ${visitor}: ${text}`);
    gathered.set(reason, { count: 0, visitor });
    setTimeout(() => {
      const { count, visitor: last } = gathered.get(reason) ?? { count: 0, visitor };
      gathered.delete(reason);
      if (count > 0) log(`refused ${count} more within ${gatherMs / 1000} s, the last one ${last}: ${text}`);
    }, gatherMs).unref();
  };
}

/** @typedef {ReturnType<typeof createRefusals>} Refuse */
