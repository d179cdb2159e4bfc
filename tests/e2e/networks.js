import { execFileSync } from 'node:child_process';

/**
 * Networks like those of people at home, made of network namespaces: an internet, on whose one machine the test itself
 * runs, and homes, each a machine behind a router with NAT. To be used within own_networks.sh.
 */

/** The test's own address on the internet. */
export const internet = '203.0.113.1';

const nowhere = '203.0.113.254';

/**
 * What a router does with the port of a connection that leaves: keeps it for all destinations, or never does. A 1:1 NAT,
 * as rented machines are behind, lets everything in besides.
 */
const nats = { cone: 'masquerade', symmetric: 'masquerade fully-random', oneToOne: 'masquerade' };

const run = (command, ...args) =>
  execFileSync(command, args, { stdio: ['ignore', 'pipe', 'pipe'], encoding: 'utf8' });
const ip = (...args) => run('ip', ...args);

/** Runs a shell command in a namespace. */
const within = (namespace, command) => run('nsenter', `--net=/run/netns/${namespace}`, 'sh', '-ec', command);

/** The internet: a switch, and our own place at it. */
export function makeInternet(t) {
  // Elsewhere it would change the networks of the machine itself.
  if (!process.env.LICHTVELD_OWN_NETWORKS) throw new Error('run this test by tests/e2e/own_networks.sh');
  // Without an address of its own a bridge has the lowest of its ports', and those who know the old one lose us when a
  // home is plugged in.
  ip('link', 'add', 'internet', 'address', '02:00:00:00:00:01', 'type', 'bridge');
  ip('addr', 'add', `${internet}/24`, 'dev', 'internet');
  ip('link', 'set', 'internet', 'up');
  // Private addresses lead nowhere, as on the internet: without a way there, coturn ends a session that asks for one.
  ip('neigh', 'add', nowhere, 'lladdr', '02:00:00:00:00:fe', 'dev', 'internet');
  ip('route', 'add', 'default', 'via', nowhere);
  t.after(() => ip('link', 'del', 'internet'));
  let homes = 0;
  return {
    /** @param {keyof typeof nats} nat */
    home: (nat) => makeHome(t, (homes += 1), nat),
  };
}

/** One more address of the test's own machine. */
export function ownAddress(address) {
  ip('addr', 'add', `${address}/24`, 'dev', 'internet');
}

/** @param {keyof typeof nats} nat */
function makeHome(t, number, nat) {
  const [machine, router, address] = [`home${number}`, `router${number}`, `203.0.113.${10 + number}`];
  for (const namespace of [machine, router]) {
    ip('netns', 'add', namespace);
    t.after(() => ip('netns', 'del', namespace));
    within(namespace, 'ip link set lo up');
  }
  ip('link', 'add', `port${number}`, 'type', 'veth', 'peer', 'name', 'wan', 'netns', router);
  ip('link', 'set', `port${number}`, 'master', 'internet', 'up');
  ip('-n', router, 'link', 'add', 'lan', 'type', 'veth', 'peer', 'name', 'eth', 'netns', machine);
  within(
    router,
    `ip addr add ${address}/24 dev wan; ip link set wan up
     ip addr add 10.0.${number}.1/24 dev lan; ip link set lan up
     echo 1 >/proc/sys/net/ipv4/ip_forward
     nft -f - <<END
     table ip home {
       chain arriving {
         type nat hook prerouting priority -100
         ${nat === 'oneToOne' ? `iifname wan dnat to 10.0.${number}.2` : ''}
       }
       chain outward { type nat hook postrouting priority 100; oifname wan ${nats[nat]}; }
       chain own {
         # Dropped before the connection is known: an answer to an uninvited packet would take the port of the line that is
         # about to be opened from within, and no two homes would ever meet.
         type filter hook input priority 0; policy accept;
         iifname wan ct state new drop
       }
       chain cut {
         type filter hook forward priority -1
       }
       chain inward {
         type filter hook forward priority 0; policy drop;
         iifname lan accept
         ct state established,related accept
         ${nat === 'oneToOne' ? 'ct status dnat accept' : ''}
       }
     }
END`,
  );
  within(
    machine,
    `ip addr add 10.0.${number}.2/24 dev eth; ip link set eth up; ip route add default via 10.0.${number}.1`,
  );
  return {
    /** The router's address, as others see it. */
    address,
    /** Words to put before a command that runs on the machine at home. */
    prefix: ['nsenter', `--net=/run/netns/${machine}`],
    /** What passes no more, in nft's words, e.g. `udp dport 40000`. */
    block: (packets) => within(router, `nft insert rule ip home inward ${packets} drop`),
    /** The line to the internet, cut and mended. */
    cut: () => within(router, 'nft add rule ip home cut drop'),
    mend: () => within(router, 'nft flush chain ip home cut'),
  };
}
