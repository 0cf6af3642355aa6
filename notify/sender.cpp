#include "notify/sender.h"

#include <memory>
#include <utility>

#include "fetch/pull/http_client.h"
#include "notify/mqtt.h"
#include "stormcellar/base/file_system.h"

namespace stormcellar::notify {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::seconds longest_delivery{30};
constexpr std::uint64_t most_password_bytes = 4096;

// Reads the first line of a file, "USER:PASSWORD", into the options.
Status read_password(const fs::path& file, MqttOptions& options) {
    std::error_code error;
    const fs::perms rights = fs::status(file, error).permissions();
    if (error) return fail(ErrorCode::not_found, "{}: {}", file.native(), error.message());
    if ((rights & fs::perms::others_read) != fs::perms::none)
        return fail(ErrorCode::permission, "{}: every user of this machine may read the password",
                    file.native());
    const auto bytes = read_file(file, most_password_bytes);
    if (!bytes) return pass_on(bytes);
    std::string line(reinterpret_cast<const char*>(bytes->data()), bytes->size());
    line.resize(std::min(line.find_first_of("\r\n"), line.size()));
    const std::size_t colon = line.find(':');
    if (colon == std::string::npos || colon == 0)
        return fail(ErrorCode::bad_argument, "{}: must have USER:PASSWORD", file.native());
    options.user = line.substr(0, colon);
    options.password = line.substr(colon + 1);
    return {};
}

}  // namespace

Result<Sender> make_sender(const NotifyRule& rule, const std::atomic<bool>& stop,
                           std::function<void()> beat) {
    if (!rule.url.empty()) {
        auto client =
            std::make_shared<pull::HttpClient>(pull::HttpOptions{.longest = longest_delivery,
                                                                 .stop = &stop,
                                                                 .beat = std::move(beat),
                                                                 .agent = "stormcellar-notify"});
        return
            [client, url = rule.url](const std::string& text) { return client->post(url, text); };
    }
    MqttOptions options{.stop = &stop, .beat = std::move(beat)};
    if (!rule.password_file.empty()) {
        if (Status read = read_password(rule.password_file, options); !read) return pass_on(read);
    }
    return [address = rule.mqtt, options](const std::string& text) {
        return publish_by_mqtt(address, text, options);
    };
}

bool may_pass(const Error& error) {
    return error.code == ErrorCode::busy || error.code == ErrorCode::truncated;
}

}  // namespace stormcellar::notify
