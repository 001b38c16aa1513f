// Photon map files. Little-endian:
//   bytes 0-7    "ALPGPHOT"
//   8-11         version, 1
//   12-15        bytes of a photon, 36
//   16-23        photons in the file
//   24-31        photons that were emitted
//   32-35        CRC-32 of bytes 0 to 31
//   then photons: P (3 float), power (3 float), from, normal (uint32 each, photon.h), reflected (3 bytes), bounces (1 byte),
//                all in world space
//   last 4       CRC-32 of the photons
#pragma once
#include "base/diagnostics.h"
#include "base/matrix.h"
#include "photonmap/photonmap.h"

namespace alpenglow {
struct OutputPolicy;
}

namespace alpenglow::photonmap {

/// Writes photons given in camera space. Returns false after an error, which is reported; an existing file is then unchanged.
bool savePhotons(const std::string& name, std::span<const Photon>, uint64_t emitted, const Matrix& cameraToWorld,
                 const OutputPolicy&, Diagnostics&, const SourcePlace& = {});

/// Reads a map into camera space. Returns null after an error, which is reported with the fault of the file.
std::shared_ptr<const PhotonMap> loadPhotons(const std::string& path, const Matrix& worldToCamera, Diagnostics&,
                                             const SourcePlace& = {});

} // namespace alpenglow::photonmap
