// Preloaded into a process whose memory is measured, with --expose-gc: what is garbage is let go on SIGUSR2.
process.on('SIGUSR2', () => globalThis.gc?.());
