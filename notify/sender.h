// notify/sender.h -- makes the function that delivers a message of a rule once, by HTTP or MQTT.
//
// Threads   One thread at a time may call the function. Any thread may set `stop`; a delivery then
//           ends within a second or so.
// Errors    make_sender(): the password file cannot be read, has no "USER:PASSWORD", or may be read
//           by every user of the machine. The function: those of pull::HttpClient::post() and of
//           publish_by_mqtt(). may_pass() says after which of these errors another try may succeed.
#pragma once

#include <atomic>
#include <functional>
#include <string>

#include "notify/notify_config.h"
#include "stormcellar/base/result.h"

namespace stormcellar::notify {

using Sender = std::function<Status(const std::string& text)>;

// `beat` is called at least once a second during a delivery. What `beat` refers to, and `stop`,
// must outlive the sender.
[[nodiscard]] Result<Sender> make_sender(const NotifyRule& rule, const std::atomic<bool>& stop,
                                         std::function<void()> beat);

// Returns true if the delivery may succeed later. Other errors are final: the answers 300 to 499
// of a server, except 408 (timeout) and 429 (too many requests), or an invalid topic.
[[nodiscard]] bool may_pass(const Error& error);

}  // namespace stormcellar::notify
