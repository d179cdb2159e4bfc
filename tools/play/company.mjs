import { spawn } from 'node:child_process';
import { createInterface } from 'node:readline';
import { setTimeout as sleep } from 'node:timers/promises';

/** Milliseconds between SIGTERM and SIGKILL. */
const patienceMs = 5000;
/** So often in a row a program is started again; one that ran for settledMs begins anew. */
const maxRestarts = 5;
const settledMs = 60_000;
/** Milliseconds before the first restart; each further one waits twice as long. */
const firstPauseMs = 500;
/** Bad usage or input, and no usable device: the next try would end in the same way. */
const hopeless = [2, 3];

/**
 * The programs that run. One that ends unasked is started again, with back-off; when that is of no use, or a signal
 * comes, all are ended.
 */
export class Company {
  #members = new Map();
  #finishing = false;
  #say;
  #onEnd;

  /**
   * @param {(text: string) => void} say  for people
   * @param {() => void} onEnd  called when nothing runs any more, before the process ends
   */
  constructor(say, onEnd) {
    this.#say = say;
    this.#onEnd = onEnd;
  }

  get finishing() {
    return this.#finishing;
  }

  /** Starts a program and keeps it running. `onLine` gets each line that it writes. */
  start(name, command, args, onLine = (_line) => {}) {
    this.#members.set(name, {
      command,
      args,
      onLine,
      restarts: 0,
      startedAt: 0,
      child: undefined,
      gone: undefined,
    });
    this.#run(name);
  }

  /** Ends everything, and this process with `code`. */
  async finish(code) {
    if (this.#finishing) return;
    this.#finishing = true;
    const all = Promise.all([...this.#members.values()].map(({ gone }) => gone));
    this.#signal('SIGTERM');
    const done = await Promise.race([all.then(() => true), sleep(patienceMs, false, { ref: false })]);
    if (!done) {
      this.#signal('SIGKILL');
      await all;
    }
    this.#onEnd();
    process.exit(code);
  }

  #run(name) {
    const member = this.#members.get(name);
    // A group of its own: Ctrl-C reaches us alone, and we end the others in order.
    const child = spawn(member.command, member.args, { detached: true, stdio: ['ignore', 'pipe', 'pipe'] });
    member.child = child;
    member.startedAt = performance.now();
    member.gone = new Promise((settle) => {
      child.once('error', (error) => settle({ code: 2, why: `could not be started: ${error.message}` }));
      child.once('exit', (code, signal) =>
        settle({ code: code ?? 1, why: signal ? `was ended by ${signal}` : `ended with exit code ${code}` }),
      );
    });
    for (const stream of [child.stdout, child.stderr])
      createInterface({ input: stream }).on('line', (line) => {
        process.stderr.write(`[${name}] ${line}\n`);
        member.onLine(line);
      });
    member.gone.then((end) => this.#ended(name, member, end));
  }

  async #ended(name, member, { code, why }) {
    if (this.#finishing) return;
    if (performance.now() - member.startedAt > settledMs) member.restarts = 0;
    if (hopeless.includes(code) || member.restarts >= maxRestarts) {
      const tries = member.restarts > 0 ? `, for the ${member.restarts + 1}th time in a row` : '';
      this.#say(`${name} ${why}${tries}; ending the rest`);
      return this.finish(code || 1);
    }
    const pause = firstPauseMs * 2 ** member.restarts;
    member.restarts += 1;
    this.#say(
      `${name} ${why}; starting it again in ${pause / 1000} s (${member.restarts} of ${maxRestarts})`,
    );
    await sleep(pause);
    if (!this.#finishing) this.#run(name);
  }

  #signal(signal) {
    for (const { child } of this.#members.values())
      if (child.pid !== undefined && child.exitCode === null && child.signalCode === null)
        process.kill(-child.pid, signal);
  }
}
