// Pictures of the commonest faults: each as it looks, and beside it cured, in the page examples/light_map.html.
import { execFileSync } from 'node:child_process';
import { mkdirSync, mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { PNG } from 'pngjs';
import { launchBrowser } from '../../tests/e2e/browser.js';
import { lookFrom, openLit, serveFiles } from '../../tests/e2e/lit_page.js';
import { executable } from '../../tests/e2e/programs.js';
import { beside } from './beside.mjs';
import { faults } from './fault_scenes.mjs';

const viewport = { width: 240, height: 180 };

/** Draws them into a folder; their names. */
export async function drawFaults(folder) {
  mkdirSync(folder, { recursive: true });
  const work = mkdtempSync(join(tmpdir(), 'lichtveld-faults-'));
  const server = await serveFiles(work);
  const browser = await launchBrowser();
  const shot = async (name, { file, options }) => {
    const scene = file.write(join(work, `${name}.gltf`));
    const outputs = ['--out', join(work, `${name}.exr`), '--gltf', join(work, `${name}.glb`)];
    execFileSync(executable, ['bake', scene, '--psf', '96', ...options, ...outputs], { stdio: 'inherit' });
    const page = await browser.newPage({ viewport });
    await openLit(page, server.url, `${name}.glb`);
    await lookFrom(page, [0, 1.6, 2.3], [0, 1.2, 0], 75);
    const picture = PNG.sync.read(await page.screenshot());
    await page.close();
    return picture;
  };
  try {
    for (const { name, bad, good } of faults) {
      const pictures = [await shot(`${name}-bad`, bad), await shot(`${name}-good`, good)];
      writeFileSync(join(folder, `${name}.png`), beside(pictures, 6));
    }
  } finally {
    await browser.close();
    server.close();
    rmSync(work, { recursive: true });
  }
  return faults.map(({ name }) => `${name}.png`);
}
