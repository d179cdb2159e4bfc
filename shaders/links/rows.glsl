// Structs of shared.h in texel buffers, a row of four words a texel. lavapipe loads such a texel at once, and a struct of a
// storage buffer word by word. Rows that a shader does not use are not fetched.

vec4 row(usamplerBuffer from, uint index) { return uintBitsToFloat(texelFetch(from, int(index))); }

Receiver receiver_at(usamplerBuffer from, uint me) {
  return Receiver(row(from, 4u * me), row(from, 4u * me + 1u), row(from, 4u * me + 2u), texelFetch(from, int(4u * me + 3u)));
}

Region region_at(usamplerBuffer from, uint index) {
  const uint first = 6u * index;
  return Region(PsfView(row(from, first), row(from, first + 1u), row(from, first + 2u), row(from, first + 3u)),
                ivec4(texelFetch(from, int(first + 4u))), ivec4(texelFetch(from, int(first + 5u))));
}
