import assert from 'node:assert/strict';
import { test } from 'node:test';
import { DoubleSide, FrontSide, MeshPhysicalMaterial, MeshStandardMaterial, Texture } from 'three';
import { Surfaces } from '../src/surfaces';

test('plain materials share two surfaces, which wait for the first map', () => {
  const surfaces = new Surfaces();
  const front = surfaces.like(new MeshStandardMaterial());
  assert.equal(surfaces.like(new MeshStandardMaterial({ color: 'red' })), front);
  assert.equal(front.side, FrontSide);
  const both = surfaces.like(new MeshStandardMaterial({ side: DoubleSide }));
  assert.equal(both.side, DoubleSide);
  assert.equal(front.visible, false);
  const map = new Texture();
  surfaces.show(map);
  for (const surface of [front, both]) assert.deepEqual([surface.visible, surface.map], [true, map]);
});

test('holes and panes are seen as the file has them', () => {
  const surfaces = new Surfaces();
  const leaf = new MeshStandardMaterial({ alphaTest: 0.4, map: new Texture() });
  const holed = surfaces.like(leaf);
  assert.equal(surfaces.like(leaf), holed, 'one for each material');
  assert.deepEqual([holed.alphaTest, holed.alphaMap, holed.transparent], [0.4, leaf.map, false]);
  const veil = surfaces.like(new MeshStandardMaterial({ transparent: true, opacity: 0.3 }));
  assert.deepEqual([veil.transparent, veil.opacity, veil.depthWrite], [true, 0.3, false]);
  const glass = surfaces.like(new MeshPhysicalMaterial({ transmission: 0.75 }));
  assert.deepEqual([glass.transparent, glass.opacity], [true, 0.25]);
  const map = new Texture();
  surfaces.show(map);
  const late = surfaces.like(new MeshPhysicalMaterial({ transmission: 1 }));
  for (const surface of [holed, veil, glass, late])
    assert.deepEqual([surface.visible, surface.map], [true, map]);
});
