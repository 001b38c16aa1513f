// What an interpreter keeps of the archives that a world reads by DelayedReadArchive.
#pragma once
#include "scene/fwd.h"
#include "scene/primitive.h"
#include <map>
#include <memory>

namespace alpenglow::ri {

struct StoredObject;

/// An archive, by the attributes around the calls that read it.
struct SharedArchive {
    bool known = false;    ///< the two below are
    bool shapes = false;   ///< there is nothing in it but shapes and their attributes
    bool settings = false; ///< there are attributes in it
    /// The calls under the same attributes.
    struct Under {
        scene::AttributesRef attributes;      ///< keeps them alive, since they are the key
        int reads = 0;                        ///< calls so far
        std::shared_ptr<StoredObject> object; ///< from the second time on
    };
    std::map<const scene::Attributes*, Under> under; ///< null: any attributes, if the archive sets none
};

} // namespace alpenglow::ri
