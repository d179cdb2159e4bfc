/**
 * What may be relayed. A message is rebuilt from the fields named here, so nothing else ever passes.
 *
 *   either way       {"id":PEER,"type":"offer"|"answer","description":SDP}
 *                    {"id":PEER,"type":"candidate","candidate":LINE,"mid":MID}
 *   server -> client {"id":PEER,"type":"role","cube":0|1|2,"players":N,"watchers":M}
 *
 * @typedef {{id: string, type: string} & Record<string, string | number>} Message
 * @typedef {{message: Message} | {refused: string}} Parsed
 */

const maxIdLength = 36;

/** @type {(value: unknown, max: number) => boolean} */
const isText = (value, max) => typeof value === 'string' && value.length > 0 && value.length <= max;
/** @type {(value: unknown, max: number) => boolean} */
const isCount = (value, max) => Number.isInteger(value) && Number(value) >= 0 && Number(value) <= max;

/** The fields of each type of message, each with its check. */
const fieldsOf = {
  offer: { description: (v, limits) => isText(v, limits.maxDescriptionLength) },
  answer: { description: (v, limits) => isText(v, limits.maxDescriptionLength) },
  candidate: {
    candidate: (v, limits) => isText(v, limits.maxCandidateLength),
    mid: (v, limits) => isText(v, limits.maxMidLength),
  },
  role: {
    cube: (v) => isCount(v, 2),
    players: (v, limits) => isCount(v, limits.maxPeople),
    watchers: (v, limits) => isCount(v, limits.maxPeople),
  },
};

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
  if (typeof json.type !== 'string' || !Object.hasOwn(fieldsOf, json.type)) return { refused: 'unknown_type' };
  if (json.type === 'role' && sender !== 'server') return { refused: 'forbidden_type' };
  if (!isText(json.id, maxIdLength)) return { refused: 'malformed' };

  const message = { id: json.id, type: json.type };
  for (const [name, accepts] of Object.entries(fieldsOf[json.type])) {
    if (!accepts(json[name], limits)) return { refused: 'malformed' };
    message[name] = json[name];
  }
  return { message };
}
