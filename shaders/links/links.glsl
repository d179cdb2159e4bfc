// A link is the number of the texel that is seen, among the valid ones, or one of these.
uint MISS(uint texels) { return texels; }           // nothing is there
uint UNKNOWN(uint texels) { return texels + 1u; }  // not told by any pixel, or faces neither way: left out of the sum

// Where a texel's word `word` of `words` is in the table. A cache line's texels lie together, word by word: a bounce, which
// goes through all words of a texel, reads one line after the other.
uint word_at(uint word, uint texel, uint words) { return (texel / LINE * words + word) * LINE + texel % LINE; }
