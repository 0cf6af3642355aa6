// daemon/config/loopback_host.h -- whether a request on a loopback port was meant for this machine.
//
// A web page may give its own name the address 127.0.0.1 (DNS rebinding). A browser then treats the
// answer as that page's own data and hands it over. But the browser sends the page's name as Host,
// so a server that answers only names of the loopback addresses tells such a page nothing. Inside
// the daemon room, for http_listener.h. Thread contract: a pure function.
#pragma once

#include <string_view>

namespace stormcellar::daemon {

// Returns true if `host`, the value of a Host field, is 127.0.0.1, localhost (in any case) or
// [::1], followed by nothing or by ":" and a port. Any port is accepted: at the other end of a
// tunnel the port differs, and no page can take the names of loopback addresses.
[[nodiscard]] bool is_loopback_host(std::string_view host) noexcept;

}  // namespace stormcellar::daemon
