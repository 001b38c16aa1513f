// Files inside zip archives (PKWARE's APPNOTE 6.3): stored or deflated, with the extensions for large ones.
#pragma once
#include "base/zipname.h"
#include "ri/source.h"
#include <string>
#include <vector>

namespace alpenglow::ri {

/// Names of the files in a zip archive, in its order, at most `most`. Empty if it cannot be read, with the reason in *why.
std::vector<std::string> zipMembers(const std::string& zip, size_t most, std::string* why);

/// The only RIB file in a zip archive. Null if there is none, or several, with the reason in *why.
std::unique_ptr<ByteSource> onlyRibOfZip(const std::string& zip, std::string* why);
/// The bytes of a file in a zip archive. By its name as it is there, else by one that differs in case or slashes. Null: *why says
/// the reason. Limits: limits::kZipEntries, kGzipRatio and kGzipBytes.
std::unique_ptr<ByteSource> zipSource(const std::string& zip, const std::string& member, std::string* why);

} // namespace alpenglow::ri
