#include "fetch/pull/http_client.h"

#include <array>
#include <exception>
#include <span>
#include <utility>

#include <curl/curl.h>

#include "stormcellar/base/version.h"

namespace stormcellar::pull {
namespace {

constexpr long http_ok = 200, http_first_redirect = 300, http_not_modified = 304,
               http_not_found = 404, http_timeout = 408, http_gone = 410, http_too_many = 429,
               http_first_error = 500;
constexpr long slowest_bytes_per_s = 200;
constexpr std::uint64_t most_error_bytes = std::uint64_t{64} << 10;

bool is_cut(CURLcode code) {
    return code == CURLE_PARTIAL_FILE || code == CURLE_RECV_ERROR || code == CURLE_HTTP2_STREAM;
}

}  // namespace

struct HttpClient::Handle {
    CURL* easy = nullptr;
    const HttpOptions* options = nullptr;
    const HttpRequest* request = nullptr;
    std::uint64_t bytes = 0;
    Status taken;
    std::array<char, CURL_ERROR_SIZE> error{};

    [[nodiscard]] long status() const {
        long status = 0;
        curl_easy_getinfo(easy, CURLINFO_RESPONSE_CODE, &status);
        return status;
    }
    [[nodiscard]] std::string header(const char* name) const {
        curl_header* found = nullptr;
        const CURLHcode code = curl_easy_header(easy, name, 0, CURLH_HEADER, -1, &found);
        return code == CURLHE_OK ? found->value : "";
    }
    [[nodiscard]] bool is_stopped() const { return options->stop != nullptr && *options->stop; }

    // Passes a piece of the body to `take`. Catches exceptions, because an exception that passed
    // through libcurl would make its handle useless.
    [[nodiscard]] Status given(std::span<const std::byte> piece) const {
        try {
            return request->take(piece);
        } catch (const std::exception& thrown) {  // memory is short
            return fail(ErrorCode::exhausted, "cannot receive the answer: {}", thrown.what());
        }
    }
    // Takes a piece of the body and returns its length. Any other number would end the transfer.
    static std::size_t take_body(char* bytes, std::size_t size, std::size_t count, void* self) {
        auto& handle = *static_cast<Handle*>(self);
        const std::size_t length = size * count;
        handle.bytes += length;
        const bool is_good = handle.status() == http_ok;
        const std::uint64_t most = is_good ? handle.request->most_bytes : most_error_bytes;
        if (handle.bytes > most) {
            handle.taken = fail(ErrorCode::over_budget, "the answer has more than {} bytes", most);
        } else if (is_good) {
            handle.taken = handle.given({reinterpret_cast<const std::byte*>(bytes), length});
        }
        return handle.taken ? length : 0;
    }
    static int go_on(void* self, curl_off_t, curl_off_t, curl_off_t, curl_off_t) {
        const auto& handle = *static_cast<const Handle*>(self);
        if (handle.options->beat) handle.options->beat();
        return handle.is_stopped() ? 1 : 0;
    }
};

HttpClient::HttpClient(HttpOptions options)
    : options_(std::move(options)), handle_(std::make_unique<Handle>()) {
    static const CURLcode once = curl_global_init(CURL_GLOBAL_DEFAULT);
    (void)once;
    handle_->options = &options_;
    handle_->easy = curl_easy_init();
    CURL* const easy = handle_->easy;
    if (easy == nullptr) return;
    const std::string agent = fmt::format("{}/{}", options_.agent, software_version);
    curl_easy_setopt(easy, CURLOPT_PROTOCOLS_STR, "http,https");
    curl_easy_setopt(easy, CURLOPT_FOLLOWLOCATION, 0L);
    // Ignore proxies from the environment and the user's .netrc; only the configuration counts.
    curl_easy_setopt(easy, CURLOPT_PROXY, "");
    curl_easy_setopt(easy, CURLOPT_NETRC, static_cast<long>(CURL_NETRC_IGNORED));
    curl_easy_setopt(easy, CURLOPT_USERAGENT, agent.c_str());
    curl_easy_setopt(easy, CURLOPT_NOSIGNAL, 1L);
    curl_easy_setopt(easy, CURLOPT_CONNECTTIMEOUT, static_cast<long>(options_.connect.count()));
    curl_easy_setopt(easy, CURLOPT_LOW_SPEED_LIMIT, slowest_bytes_per_s);
    curl_easy_setopt(easy, CURLOPT_LOW_SPEED_TIME, static_cast<long>(options_.stall.count()));
    curl_easy_setopt(easy, CURLOPT_TIMEOUT, static_cast<long>(options_.longest.count()));
    curl_easy_setopt(easy, CURLOPT_ERRORBUFFER, handle_->error.data());
    curl_easy_setopt(easy, CURLOPT_WRITEFUNCTION, &Handle::take_body);
    curl_easy_setopt(easy, CURLOPT_WRITEDATA, handle_.get());
    curl_easy_setopt(easy, CURLOPT_NOPROGRESS, 0L);
    curl_easy_setopt(easy, CURLOPT_XFERINFOFUNCTION, &Handle::go_on);
    curl_easy_setopt(easy, CURLOPT_XFERINFODATA, handle_.get());
}

HttpClient::~HttpClient() {
    if (handle_->easy != nullptr) curl_easy_cleanup(handle_->easy);
}

// Runs a transfer. Also sends `header` unless it is empty. Fails if there is no whole answer.
Status HttpClient::transfer(const HttpRequest& request, const std::string& header) {
    Handle& handle = *handle_;
    if (handle.easy == nullptr) return fail(ErrorCode::busy, "libcurl cannot be started");
    handle.request = &request;
    handle.bytes = 0;
    handle.taken = {};
    handle.error[0] = '\0';
    retry_after_.reset();
    curl_slist* const headers =
        header.empty() ? nullptr : curl_slist_append(nullptr, header.c_str());
    curl_easy_setopt(handle.easy, CURLOPT_URL, request.url.c_str());
    curl_easy_setopt(handle.easy, CURLOPT_HTTPHEADER, headers);
    const CURLcode code = curl_easy_perform(handle.easy);
    curl_easy_setopt(handle.easy, CURLOPT_HTTPHEADER, nullptr);
    curl_slist_free_all(headers);
    const std::string& url = request.url;
    if (handle.is_stopped()) return fail(ErrorCode::busy, "{}: stopped", url);
    if (!handle.taken) {
        return fail(handle.taken.error().code, "{}: {}", url, handle.taken.error().message);
    }
    if (code == CURLE_OK) return {};
    const char* const text =
        handle.error[0] != '\0' ? handle.error.data() : curl_easy_strerror(code);
    const bool has_begun = is_cut(code) && handle.bytes > 0;
    return fail(has_begun ? ErrorCode::truncated : ErrorCode::busy, "{}: {}", url, text);
}

// Returns the error for an answer that is not a success, and notes the wait that the answer
// requests.
tl::unexpected<Error> HttpClient::refusal(const std::string& url) {
    const long status = handle_->status();
    curl_off_t seconds = 0;
    curl_easy_getinfo(handle_->easy, CURLINFO_RETRY_AFTER, &seconds);
    if (seconds > 0) retry_after_ = std::chrono::seconds{seconds};
    const bool passes =
        status == http_timeout || status == http_too_many || status >= http_first_error;
    const bool is_gone = status == http_not_found || status == http_gone;
    return fail(passes    ? ErrorCode::busy
                : is_gone ? ErrorCode::not_found
                          : ErrorCode::io,
                "{}: the server answered {}", url, status);
}

Result<HttpAnswer> HttpClient::get(const HttpRequest& request) {
    const Status done = transfer(
        request, request.known_tag.empty() ? std::string{} : "If-None-Match: " + request.known_tag);
    if (!done) return pass_on(done);
    const long status = handle_->status();
    if (status == http_ok || (status == http_not_modified && !request.known_tag.empty())) {
        return HttpAnswer{status == http_not_modified, handle_->header("ETag"), handle_->bytes};
    }
    return refusal(request.url);
}

Status HttpClient::post(const std::string& url, const std::string& json) {
    CURL* const easy = handle_->easy;
    if (easy == nullptr) return fail(ErrorCode::busy, "libcurl cannot be started");
    curl_easy_setopt(easy, CURLOPT_POSTFIELDSIZE_LARGE, static_cast<curl_off_t>(json.size()));
    curl_easy_setopt(easy, CURLOPT_POSTFIELDS, json.c_str());  // makes the request a POST
    const auto ignore = [](std::span<const std::byte>) { return Status{}; };
    const Status done =
        transfer({.url = url, .known_tag = {}, .most_bytes = most_error_bytes, .take = ignore},
                 "Content-Type: application/json");
    curl_easy_setopt(easy, CURLOPT_HTTPGET, 1L);
    // The status decides, even if the body of the answer is too long or cut: the server has the
    // JSON.
    const long status = handle_->status();
    if (status >= http_ok && status < http_first_redirect) return {};
    return done || status >= http_first_redirect ? refusal(url) : done;
}

}  // namespace stormcellar::pull
