// A link is replaced, and direct light with it: for each texel and half of the directions the sum of w Le of the lamps that
// it sees, a whole number, so that what comes and goes again leaves nothing behind. Included by a shader that defines
// link_at() and put_link() for its table. A texel's link must not be replaced twice in one dispatch.
#include "direct_light.glsl"

layout(binding = 13) readonly buffer Lamps { float lamps[]; };  // Le of each, three channels [scaled]
layout(binding = 14) buffer Direct { uint direct[]; };          // direct_light.glsl

uint share_of(uint link, uint channel, vec3 normal, vec4 direction) {
  return link < constants.lamps ? direct_share(lamps[3u * link + channel], normal, direction) : 0u;
}

void relink(uint me, vec3 normal, Region region, uint link) {
  const uint pair = uint(region.store.z), nth = pair - constants.first_pair;
  const uint was = link_at(nth, me, constants.pairs);
  put_link(nth, me, link, constants.pairs);
  const bool changes = min(link, was) < constants.lamps && max(link, was) >= constants.lamps_alike;
  const uint channels = changes ? 3u : 0u;  // as in direct_light.comp
  for (uint channel = 0u; channel < channels; ++channel) {
    const uint sum = direct_at(me, pair < constants.half_pairs ? 0u : 1u, channel);
    atomicAdd(direct[sum], share_of(link, channel, normal, region.view.direction) -
                               share_of(was, channel, normal, region.view.direction));
  }
}
