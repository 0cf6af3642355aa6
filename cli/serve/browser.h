// cli/serve/browser.h -- opens the user's browser.
//
// Threads   One thread at a time.
#pragma once

#include <string>

namespace stormcellar::cli {

// Asks the desktop, by xdg-open, to show an address. Returns false without a desktop, or if
// xdg-open is not installed. Does not notice later failures of the browser. The browser outlives
// the program.
bool open_in_browser(const std::string& address);

}  // namespace stormcellar::cli
