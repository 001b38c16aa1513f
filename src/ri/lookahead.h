// Which pictures of a scene are made to be read by it: what its Make requests (MakeShadow, MakeCubeFaceEnvironment ...) name.
#pragma once
#include "ri/reader.h"
#include <set>

namespace alpenglow::ri {

/// The names of the pictures that the Make requests of a RIB file read, as the file has them. The file is read for them when the
/// word "Make" is in it, otherwise only looked through; archives are followed in the former case alone. Of the options, folders,
/// permissions to read and the stop flag hold. Empty for what is no regular file: standard input and pipes can be read once.
std::set<std::string> picturesOfMakeRequests(const std::string& path, const ReaderOptions&);

} // namespace alpenglow::ri
