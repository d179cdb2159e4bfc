// The table with links of 32 bits.
layout(binding = 9) buffer Table { uint table[]; };

uint link_at(uint pair, uint texel, uint pairs) { return table[word_at(pair, texel, pairs)]; }
void put_link(uint pair, uint texel, uint link, uint pairs) { table[word_at(pair, texel, pairs)] = link; }
