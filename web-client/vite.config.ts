import { defineConfig } from 'vite';

export default defineConfig({
  build: {
    target: 'es2022',
    // three.js alone is larger than Vite's default of 500 kB.
    chunkSizeWarningLimit: 900,
  },
});
