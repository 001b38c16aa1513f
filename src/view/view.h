// alpenglow view, behind a single function.
#pragma once
#include "view/session.h"

namespace alpenglow::view {

/// Why a view ended. PortTaken and NoScene were reported.
enum class ViewEnd { Done, PortTaken, NoScene };
/// Serves the page until *stop is set. `announce` receives the address once it is available. port 0: any free port.
ViewEnd view(ViewOptions, int port, const StopFlag* stop, const std::function<void(const std::string&)>& announce,
             std::string* fault);

} // namespace alpenglow::view
