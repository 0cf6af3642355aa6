// daemon/config/loopback_host.h -- whether a request on a loopback port was meant for this machine.
//
// A page of the web may give its own name the address 127.0.0.1 (DNS rebinding). A browser then
// takes what is answered there for that page's own data and hands it over. It sends the page's name
// as Host, so whoever answers only names of the loopback addresses tells such a page nothing.
// Inside the daemon room, for http_listener.h.
#pragma once

#include <string_view>

namespace stormcellar::daemon {

// Whether `host`, the value of a Host field, is 127.0.0.1, localhost (in any case) or [::1], with
// nothing behind it or ":" and a port. Any port: at the other end of a tunnel it is another one,
// and no page can give the names of loopback addresses to itself.
[[nodiscard]] bool is_loopback_host(std::string_view host) noexcept;

}  // namespace stormcellar::daemon
