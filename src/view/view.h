// alpenglow view: the whole of it behind one function.
#pragma once
#include "view/session.h"

namespace alpenglow::view {

enum class ViewEnd { Done, PortTaken, NoScene };
/// Serves the page until *stop is set. `announce` gets the address once it is there. port 0: a free one.
ViewEnd view(ViewOptions, int port, const StopFlag* stop, const std::function<void(const std::string&)>& announce,
             std::string* fault);

} // namespace alpenglow::view
