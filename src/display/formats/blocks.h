// Texels of compressed blocks of 4 x 4, as graphics cards have them (BC1 to BC7: S3TC, RGTC, BPTC).
#pragma once
#include <cstddef>
#include <cstdint>

namespace alpenglow::display {

/// Kinds of blocks, by the names of Direct3D.
enum class Block { Bc1, Bc1Alpha, Bc2, Bc3, Bc4, Bc4Signed, Bc5, Bc5Signed, Bc6, Bc6Signed, Bc7 };

/// Bytes of a block.
size_t bytesOf(Block);
/// Channels that it has: r; r g; r g b; r g b a.
int channelsOf(Block);
/// 16 texels, row by row, of four numbers each; channels that the block does not have are not written. Numbers of Bc1, 2, 3 and 7
/// are multiples of 1/255. Every block means something; reserved ones of Bc6 and Bc7 are black (and clear).
void decodeBlock(Block, const uint8_t*, float texels[16][4]);

// bptc.cpp
void decodeBc6(const uint8_t*, bool isSigned, float texels[16][4]);
void decodeBc7(const uint8_t*, float texels[16][4]);

} // namespace alpenglow::display
