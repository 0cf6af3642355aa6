#include "notify/mqtt.h"

#include <memory>

#include <mosquitto.h>

#include "base/steady_time.h"

namespace stormcellar::notify {
namespace {

constexpr int acknowledged_delivery = 1;  // quality of service
constexpr int keep_alive_s = 60;
constexpr int step_ms = 200;

// A delivery, for the callbacks of libmosquitto. They run inside mosquitto_loop().
struct MqttDelivery {
    const MqttAddress& address;
    const std::string& text;
    bool is_acknowledged = false;
    int refusal = 0;  // the code of the broker's answer to CONNECT; 0: none
    int error = MOSQ_ERR_SUCCESS;

    static void connected(mosquitto* client, void* self, int code) {
        auto& delivery = *static_cast<MqttDelivery*>(self);
        delivery.refusal = code;
        if (code != 0) return;
        delivery.error = mosquitto_publish(client, nullptr, delivery.address.topic.c_str(),
                                           static_cast<int>(delivery.text.size()),
                                           delivery.text.data(), acknowledged_delivery, false);
    }
    static void published(mosquitto*, void* self, int) {
        static_cast<MqttDelivery*>(self)->is_acknowledged = true;
    }
};

struct MosquittoDeleter {
    void operator()(mosquitto* client) const { mosquitto_destroy(client); }
};
using MosquittoClient = std::unique_ptr<mosquitto, MosquittoDeleter>;

ErrorCode code_of(int error) {
    return error == MOSQ_ERR_INVAL || error == MOSQ_ERR_MALFORMED_UTF8 ? ErrorCode::bad_argument
                                                                       : ErrorCode::busy;
}

// Runs the connection until the broker has acknowledged the message. Returns an error if that does
// not happen.
Status deliver(mosquitto* client, MqttDelivery& delivery, const MqttOptions& options) {
    const auto stops = [&] { return options.stop != nullptr && *options.stop; };
    const SteadyTime end = steady_now() + options.longest;
    while (!delivery.is_acknowledged) {
        if (stops()) return fail(ErrorCode::busy, "stopped");
        if (steady_now() >= end)
            return fail(ErrorCode::busy, "no answer in {} s", options.longest.count());
        if (options.beat) options.beat();
        const int error = mosquitto_loop(client, step_ms, 1);
        if (delivery.refusal != 0)
            return fail(ErrorCode::busy, "{}", mosquitto_connack_string(delivery.refusal));
        for (const int code : {delivery.error, error}) {
            if (code != MOSQ_ERR_SUCCESS && !delivery.is_acknowledged)
                return fail(code_of(code), "{}", mosquitto_strerror(code));
        }
    }
    return {};
}

}  // namespace

Status publish_by_mqtt(const MqttAddress& address, const std::string& text,
                       const MqttOptions& options) {
    static const int once = mosquitto_lib_init();
    (void)once;
    const auto named = [&](const Error& error) {
        return fail(error.code, "{}://{}:{}/{}: {}", address.tls ? "mqtts" : "mqtt", address.host,
                    address.port, address.topic, error.message);
    };
    MqttDelivery delivery{address, text};
    const MosquittoClient client(mosquitto_new(nullptr, true, &delivery));
    if (client == nullptr) return named({ErrorCode::busy, "libmosquitto cannot be started"});
    mosquitto_connect_callback_set(client.get(), &MqttDelivery::connected);
    mosquitto_publish_callback_set(client.get(), &MqttDelivery::published);
    if (address.tls &&
        mosquitto_int_option(client.get(), MOSQ_OPT_TLS_USE_OS_CERTS, 1) != MOSQ_ERR_SUCCESS)
        return named({ErrorCode::unsupported, "this libmosquitto has no TLS"});
    if (!options.user.empty())
        mosquitto_username_pw_set(client.get(), options.user.c_str(), options.password.c_str());
    // This does not wait for the connection, which may take minutes.
    const int error =
        mosquitto_connect_async(client.get(), address.host.c_str(), address.port, keep_alive_s);
    if (error != MOSQ_ERR_SUCCESS)
        return named({code_of(error), error == MOSQ_ERR_ERRNO
                                          ? std::generic_category().message(errno)
                                          : mosquitto_strerror(error)});
    const Status done = deliver(client.get(), delivery, options);
    mosquitto_disconnect(client.get());
    return done ? done : named(done.error());
}

}  // namespace stormcellar::notify
