// cli/serve/browser.h -- opens the user's browser.
//
// Threads   One thread at a time.
#pragma once

#include <string>

namespace stormcellar::cli {

// Asks the desktop to show an address, by xdg-open. Returns false without a desktop, or if xdg-open
// is not installed. Failures of the browser afterward go unnoticed. The browser outlives the
// program.
bool open_in_browser(const std::string& address);

}  // namespace stormcellar::cli
