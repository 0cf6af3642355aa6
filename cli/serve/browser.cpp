#include "cli/serve/browser.h"

#include <cstdlib>

#include "base/spawn.h"

namespace stormcellar::cli {
namespace {

bool is_set(const char* variable) {
    const char* value = std::getenv(variable);
    return value != nullptr && *value != '\0';
}

// Returns false if there is no desktop. xdg-open would then start a text browser in the terminal,
// which cannot draw the page.
bool has_desktop() {
    return is_set("DISPLAY") || is_set("WAYLAND_DISPLAY") || is_set("BROWSER");
}

}  // namespace

bool open_in_browser(const std::string& address) {
    if (!has_desktop()) return false;
    // The browser has its own group, so that Ctrl-C here does not end it.
    const std::filesystem::path opener = find_program("xdg-open");
    return !opener.empty() && spawn(opener, {address}).has_value();
}

}  // namespace stormcellar::cli
