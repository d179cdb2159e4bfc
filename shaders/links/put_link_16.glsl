// The table with links of 16 bits. Two pairs share a word, so that a bounce loads both at once.
layout(binding = 9) buffer Table { uint16_t table[]; };

uint slot_of_link(uint pair, uint texel, uint pairs) { return 2u * word_at(pair / 2u, texel, pairs / 2u) + pair % 2u; }
uint link_at(uint pair, uint texel, uint pairs) { return uint(table[slot_of_link(pair, texel, pairs)]); }
void put_link(uint pair, uint texel, uint link, uint pairs) { table[slot_of_link(pair, texel, pairs)] = uint16_t(link); }
