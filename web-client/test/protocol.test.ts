import assert from 'node:assert/strict';
import { test } from 'node:test';
import { Receiver, formatDimming, mapComplete, maxMapBytes, parseLights, parsePlaces } from '../src/protocol';

const bytes = (hex: string): ArrayBuffer =>
  new Uint8Array(Buffer.from(hex.replaceAll(' ', ''), 'hex')).buffer;
/** The first bytes of a PNG of 256 x 256 texels, cut inside its signature as a chunk may be. */
const chunks = [
  bytes('89 50 4e'),
  bytes('47 0d 0a 1a 0a 00 00 00 0d'),
  bytes('49 48 44 52 00 00 01 00 00 00 01 00'),
];

test('a map is its chunks in order, ended by the text', async () => {
  const receiver = new Receiver();
  for (const chunk of chunks) assert.equal(receiver.take(chunk), undefined);
  const received = receiver.take(mapComplete);
  assert.equal(received?.kind, 'map');
  assert.ok(received?.kind === 'map');
  assert.equal(received.format, 'png');
  const joined = Buffer.from(await received.bytes.arrayBuffer()).toString('hex');
  assert.equal(joined, '89504e470d0a1a0a0000000d494844520000010000000100');
});

test('places between two chunks do not disturb the map', () => {
  const receiver = new Receiver();
  receiver.take(chunks[0]!);
  assert.deepEqual(receiver.take('1!2/3!4'), {
    kind: 'places',
    places: [
      { x: 1, y: 2 },
      { x: 3, y: 4 },
    ],
  });
  for (const chunk of chunks.slice(1)) receiver.take(chunk);
  assert.equal(receiver.take(mapComplete)?.kind, 'map');
});

test('places are read as the server writes them', () => {
  assert.deepEqual(parsePlaces('-1.3!1.3/1.3!2.5'), [
    { x: -1.3, y: 1.3 },
    { x: 1.3, y: 2.5 },
  ]);
  assert.deepEqual(parsePlaces('0!-0.00000001'), [{ x: 0, y: -0.00000001 }]);
});

test('what is no place is refused', () => {
  const bad = [
    '',
    '1',
    '1!',
    '!1',
    '1!2/',
    '1!2//3!4',
    '1!2/3',
    'NaN!0',
    'Infinity!0',
    '0x1!0',
    '1!2 ',
    ' 1!2',
    '1,5!2',
    'up',
  ];
  for (const text of [...bad, '1!2/'.repeat(100) + '1!2', `${'9'.repeat(400)}!1`]) {
    assert.equal(parsePlaces(text), undefined, text);
    assert.equal(new Receiver().take(text)?.kind, 'refused', text);
  }
});

test('what is no PNG is refused, and the next map comes through', () => {
  const receiver = new Receiver();
  assert.equal(receiver.take(mapComplete)?.kind, 'refused');
  receiver.take(bytes('ff d8 ff e0 00 10 4a 46 49 46'));
  assert.equal(receiver.take(mapComplete)?.kind, 'refused');
  for (const chunk of chunks) receiver.take(chunk);
  assert.equal(receiver.take(mapComplete)?.kind, 'map');
});

test('a map without end is refused once, forgotten, and the next one comes through', () => {
  const receiver = new Receiver();
  const chunk = new ArrayBuffer(1024 * 1024);
  const answers = Array.from({ length: maxMapBytes / chunk.byteLength + 8 }, () => receiver.take(chunk));
  assert.equal(answers.filter((answer) => answer?.kind === 'refused').length, 1);
  assert.equal(receiver.take(mapComplete), undefined);
  for (const good of chunks) receiver.take(good);
  assert.equal(receiver.take(mapComplete)?.kind, 'map');
});

test('lights are read as the server writes them, and nothing else is', () => {
  const text = '{"lights":[{"name":"lamp","scale":[1,0.5,0]}]}';
  assert.deepEqual(parseLights(text), { lights: [{ name: 'lamp', scale: [1, 0.5, 0] }] });
  assert.equal(parseLights('{"lights":[],"sky":"#0a80ff"}')?.sky, '#0a80ff');
  assert.equal(parseLights('{"lights":[],"sky":"url(x)"}')?.sky, undefined);
  assert.deepEqual(new Receiver().take(text), { kind: 'lights', ...parseLights(text) });
  for (const wrong of [
    '',
    '{',
    '{}',
    '{"lights":1}',
    '{"lights":[null]}',
    '{"lights":[{"name":"lamp","scale":[1,1]}]}',
    '{"lights":[{"name":"lamp","scale":[1,1,-1]}]}',
    '{"lights":[{"name":"lamp","scale":[1,1,17]}]}',
    '{"lights":[{"name":1,"scale":[1,1,1]}]}',
    `{"lights":[${Array(65).fill('{"name":"l","scale":[1,1,1]}').join()}]}`,
  ])
    assert.equal(parseLights(wrong), undefined, wrong);
});

test('what is asked of a light is within its limits', () => {
  assert.equal(formatDimming(0, [1, 0.5, 1 / 3]), 'light 1 1.0000 0.5000 0.3333');
  assert.equal(formatDimming(11, [-1, 99, 0]), 'light 12 0.0000 16.0000 0.0000');
});
