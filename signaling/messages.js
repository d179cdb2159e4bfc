/**
 * What may be relayed. A message is rebuilt from the fields named here, so nothing else ever passes.
 *
 *   either way       {"id":PEER,"type":"offer"|"answer","description":SDP}; a client's offer may have "session":SECRET,
 *                    and the relay adds "seat" and "name" to it (room.js)
 *                    {"id":PEER,"type":"candidate","candidate":LINE,"mid":MID}
 *   client -> server {"id":PEER,"type":"rejoin","session":SECRET}
 *   server -> client {"id":PEER,"type":"role","cube":0|1|2,"players":N,"watchers":M}, and maybe "session":SECRET
 *   server -> relay  {"type":"work","stages":[{"name":NAME,"runs":N,"seconds":S},...],"passes":[...],
 *                     "counts":[{"name":NAME,"value":N},...]}
 *                    what the render server's work has taken since its start, shown in /metrics
 *
 * @typedef {{name: string, runs: number, seconds: number}[]} Times
 * @typedef {{name: string, value: number}[]} Counts
 * @typedef {{type: 'work', stages: Times, passes: Times, counts: Counts}} Work
 * @typedef {{id: string, type: string} & Record<string, string | number>} Message
 * @typedef {{message: Message} | {work: Work} | {refused: string}} Parsed
 */

const maxIdLength = 36;

/** @type {(value: unknown, max: number) => boolean} */
const isText = (value, max) => typeof value === 'string' && value.length > 0 && value.length <= max;
/** @type {(value: unknown, max: number) => boolean} */
const isCount = (value, max) => Number.isInteger(value) && Number(value) >= 0 && Number(value) <= max;

/** @type {(value: unknown, limits: import('./limits.js').Limits) => boolean} */
const isSession = (value, limits) =>
  isText(value, limits.maxSessionLength) && /^[A-Za-z0-9_-]+$/.test(String(value));

/** The fields of each type of message, each with its check. */
const fieldsOf = {
  offer: { description: (v, limits) => isText(v, limits.maxDescriptionLength) },
  answer: { description: (v, limits) => isText(v, limits.maxDescriptionLength) },
  candidate: {
    candidate: (v, limits) => isText(v, limits.maxCandidateLength),
    mid: (v, limits) => isText(v, limits.maxMidLength),
  },
  rejoin: { session: isSession },
  role: {
    cube: (v) => isCount(v, 2),
    players: (v, limits) => isCount(v, limits.maxPeople),
    watchers: (v, limits) => isCount(v, limits.maxPeople),
  },
};

/** Those that may be missing. */
const optionalFieldsOf = { offer: { session: isSession }, role: { session: isSession } };

/** Types that only one side may send. */
const senderOf = { rejoin: 'client', role: 'server', work: 'server' };

/** @type {(value: unknown) => boolean} */
const isAnyCount = (value) => isCount(value, Number.MAX_SAFE_INTEGER);

/** The members of each entry of a report of work, each with its check. */
const timed = { runs: isAnyCount, seconds: (v) => Number.isFinite(v) && v >= 0 };
const workFields = {
  stages: timed,
  passes: timed,
  counts: { value: isAnyCount },
};

/** @type {(json: Record<string, unknown>, limits: import('./limits.js').Limits) => Parsed} */
function parseWork(json, { maxWorkEntries }) {
  const work = { type: 'work' };
  for (const [list, fields] of Object.entries(workFields)) {
    const entries = json[list];
    if (!Array.isArray(entries) || entries.length > maxWorkEntries) return { refused: 'malformed' };
    work[list] = [];
    for (const entry of entries) {
      if (typeof entry !== 'object' || entry === null) return { refused: 'malformed' };
      if (typeof entry.name !== 'string' || !/^[a-z_]{1,32}$/.test(entry.name))
        return { refused: 'malformed' };
      const kept = { name: entry.name };
      for (const [name, accepts] of Object.entries(fields)) {
        if (!accepts(entry[name])) return { refused: 'malformed' };
        kept[name] = entry[name];
      }
      work[list].push(kept);
    }
  }
  return { work: /** @type {Work} */ (work) };
}

/**
 * @param {string} text  one text message as it came
 * @param {'server' | 'client'} sender
 * @param {import('./limits.js').Limits} limits
 * @returns {Parsed} the message with only its known fields, or why it is refused
 */
export function parseMessage(text, sender, limits) {
  let json;
  try {
    json = JSON.parse(text);
  } catch {
    return { refused: 'not_json' };
  }
  if (typeof json !== 'object' || json === null || Array.isArray(json)) return { refused: 'malformed' };
  const known = json.type === 'work' || (typeof json.type === 'string' && Object.hasOwn(fieldsOf, json.type));
  if (!known) return { refused: 'unknown_type' };
  if ((senderOf[json.type] ?? sender) !== sender) return { refused: 'forbidden_type' };
  if (json.type === 'work') return parseWork(json, limits);
  if (!isText(json.id, maxIdLength)) return { refused: 'malformed' };

  const message = { id: json.id, type: json.type };
  for (const [name, accepts] of Object.entries(fieldsOf[json.type])) {
    if (!accepts(json[name], limits)) return { refused: 'malformed' };
    message[name] = json[name];
  }
  for (const [name, accepts] of Object.entries(optionalFieldsOf[json.type] ?? {})) {
    if (json[name] === undefined) continue;
    if (!accepts(json[name], limits)) return { refused: 'malformed' };
    message[name] = json[name];
  }
  return { message };
}
