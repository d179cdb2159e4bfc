// The table with links of 16 bits. Two pairs share a word, so that a bounce loads both at once.
layout(binding = 9) buffer Table { uint16_t table[]; };

void put_link(uint pair, uint texel, uint link, uint texels) {
  table[2u * ((pair / 2u) * texels + texel) + pair % 2u] = uint16_t(link);
}
