// notify/mqtt.h -- publishes one message to a topic of an MQTT broker.
//
// Each message has a connection of its own (MQTT 3.1.1, a clean session, quality of service 1, not
// retained), because messages are rare. The message counts as delivered when the broker has
// acknowledged it. A broker of MQTT 3.1.1 also acknowledges a message that it refuses because the
// user may not publish it. With TLS, the certificate of the broker must be for the address's host,
// and from an authority that the system trusts. Without TLS, use a broker on this machine, or on a
// network that you trust.
//
// Threads   Any thread; only looking up the name of a host blocks for longer than a second.
// Errors    busy: no connection, a refused certificate, user or password, no acknowledgment in
//           time, or `stop`.
//           bad_argument: the topic is not valid.
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <string>

#include "notify/notify_config.h"
#include "stormcellar/base/result.h"

namespace stormcellar::notify {

struct MqttOptions {
    std::string user = {}, password = {};  // of the broker; both empty: none
    std::chrono::seconds longest{20};      // limit of the whole delivery
    const std::atomic<bool>* stop = nullptr;
    std::function<void()> beat = {};  // called at least once a second
};

[[nodiscard]] Status publish_by_mqtt(const MqttAddress& address, const std::string& text,
                                     const MqttOptions& options);

}  // namespace stormcellar::notify
