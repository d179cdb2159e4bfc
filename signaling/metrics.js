import { Counter, Gauge, Registry } from 'prom-client';

/**
 * The counters of one signaling server, and what the render server says of its work, in a registry of their own.
 * @param {import('./room.js').Room} room
 * @param {import('./address_gate.js').AddressGate<any, any>} gate
 */
export function createMetrics(room, gate) {
  const registry = new Registry();
  const registers = [registry];
  /** @type {(name: string, help: string, labelNames?: string[]) => Counter} */
  const counter = (name, help, labelNames = []) =>
    new Counter({ name: `lichtveld_signaling_${name}`, help, labelNames, registers });
  /** @type {(name: string, help: string, value: () => number) => Gauge} */
  const gauge = (name, help, value) =>
    new Gauge({
      name: `lichtveld_signaling_${name}`,
      help,
      registers,
      collect() {
        this.set(value());
      },
    });

  gauge('clients', 'Clients connected now.', () => room.clientCount);
  gauge('server_connected', '1 while a render server is connected, else 0.', () => Number(room.hasServer));

  gauge('tcp_connections', 'TCP connections now, WebSockets included.', () => gate.connections);
  gauge('addresses', 'Addresses that are remembered for their rates.', () => gate.addresses);

  /** @type {(of: string, label: string) => (times: import('./messages.js').Times) => void} */
  const workOf = (of, label) => {
    const total = (name, help) =>
      new Gauge({ name: `lichtveld_server_${label}_${name}`, help, labelNames: [label], registers });
    const runs = total('runs_total', `How often ${of} has run since the render server's start.`);
    const seconds = total('seconds_total', `Seconds that ${of} has taken since the render server's start.`);
    return (times) => {
      runs.reset();
      seconds.reset();
      for (const time of times) {
        runs.set({ [label]: time.name }, time.runs);
        seconds.set({ [label]: time.name }, time.seconds);
      }
    };
  };
  const showStages = workOf('each stage of a map', 'stage');
  const showPasses = workOf('each pass on the GPU', 'pass');
  const counted = new Gauge({
    name: 'lichtveld_server_counted_total',
    help: "What the render server has counted since its start: maps, moves, links that it looked at again.",
    labelNames: ['what'],
    registers,
  });
  return {
    registry,
    /**
     * What the render server's work has taken; nothing is shown while none is there.
     * @param {Omit<import('./messages.js').Work, 'type'>} [work]
     */
    showWork: ({ stages, passes, counts } = { stages: [], passes: [], counts: [] }) => {
      showStages(stages);
      showPasses(passes);
      counted.reset();
      for (const { name, value } of counts) counted.set({ what: name }, value);
    },
    connections: counter('connections_total', 'Connections accepted, by role.', ['role']),
    refusedConnections: counter('refused_connections_total', 'Connections refused, by reason.', ['reason']),
    refusedRequests: counter('refused_requests_total', 'Requests refused, by reason.', ['reason']),
    refusedMessages: counter('refused_messages_total', 'Messages refused, by reason.', ['reason']),
    droppedConnections: counter('dropped_connections_total', 'Connections that we ended, by reason.', [
      'reason',
    ]),
    relayedMessages: counter('relayed_messages_total', 'Messages relayed, by type.', ['type']),
    relayedBytes: counter('relayed_bytes_total', 'Bytes of the messages relayed.'),
  };
}

/** @typedef {ReturnType<typeof createMetrics>} Metrics */
