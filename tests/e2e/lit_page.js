import { createReadStream } from 'node:fs';
import { createServer } from 'node:http';
import { extname, join, normalize } from 'node:path';
import { root } from './programs.js';

const types = { '.html': 'text/html', '.js': 'text/javascript' };

/** Serves this repository, and a folder as /lit/, until `close`. */
export async function serveFiles(folder) {
  const server = createServer((request, response) => {
    const path = normalize(decodeURIComponent(new URL(request.url, 'http://localhost').pathname));
    const file = path.startsWith('/lit/') ? join(folder, path.slice('/lit/'.length)) : join(root, path);
    const content = createReadStream(file);
    content.on('error', () => response.writeHead(404).end());
    content.once('open', () => {
      response.writeHead(200, { 'Content-Type': types[extname(file)] ?? 'application/octet-stream' });
      content.pipe(response);
    });
  });
  await new Promise((listening) => server.listen(0, '127.0.0.1', listening));
  return { url: `http://127.0.0.1:${server.address().port}`, close: () => server.close() };
}

/**
 * Opens examples/light_map.html with a scene of that folder.
 * @param {import('playwright-core').Page} page
 * @param {string} url  of serveFiles
 */
export async function openLit(page, url, scene) {
  const thrown = [];
  page.on('pageerror', (error) => thrown.push(error));
  await page.goto(`${url}/examples/light_map.html?scene=/lit/${encodeURIComponent(scene)}`);
  await page
    .waitForFunction(() => window.view, null, { timeout: 60_000 })
    .catch((late) => {
      throw thrown[0] ?? late;
    });
}

/** Looks from a place of the scene towards another, and waits until that is drawn. */
export async function lookFrom(page, from, to, fieldOfView = 60) {
  await page.evaluate(
    ([from, to, fieldOfView]) => {
      const { camera, controls } = window.view;
      camera.fov = fieldOfView;
      camera.updateProjectionMatrix();
      camera.position.set(...from);
      controls.target.set(...to);
      controls.update();
      camera.updateMatrixWorld();
      const drawn = (frames) =>
        new Promise((proceed) =>
          requestAnimationFrame(() => (frames > 1 ? drawn(frames - 1).then(proceed) : proceed())),
        );
      return drawn(4);
    },
    [from, to, fieldOfView],
  );
}
