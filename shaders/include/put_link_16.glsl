// The table with links of 16 bits. Two pairs share a word, so that a bounce loads both at once.
layout(binding = 9) buffer Table { uint16_t table[]; };

void put_link(uint pair, uint texel, uint link, uint pairs) {
  table[2u * word_at(pair / 2u, texel, pairs / 2u) + pair % 2u] = uint16_t(link);
}
