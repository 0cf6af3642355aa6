#include "fetch/bucket/transfers.h"

#include <algorithm>
#include <array>
#include <utility>

#include "stormcellar/base/version.h"

namespace stormcellar::fetch {
namespace {

constexpr int longest_poll_ms = 100;  // time between two checks of the flag
constexpr long connect_timeout_s = 20;
constexpr long http_ok = 200;
constexpr long http_partial = 206;
constexpr long http_range = 416;
constexpr long http_changed = 412;
constexpr long http_too_many = 429;
constexpr long slowest_bytes_per_s = 200;
constexpr std::uint64_t most_error_bytes = std::uint64_t{1} << 20;
constexpr std::chrono::hours most_retry_after{24};

// Returns true if another try would get the same status: 403, 404 or 410.
bool is_for_good(long status) {
    return status == 403 || status == 404 || status == 410;
}

// Returns true if the same request may succeed later, for example after an error of the network or
// while a server is busy.
bool is_passing(CURLcode code, long status) {
    switch (code) {
        case CURLE_OK:
            return status >= 500 || status == http_too_many || status == 408;
        case CURLE_COULDNT_RESOLVE_HOST:
        case CURLE_COULDNT_CONNECT:
        case CURLE_PARTIAL_FILE:
        case CURLE_OPERATION_TIMEDOUT:
        case CURLE_GOT_NOTHING:
        case CURLE_SEND_ERROR:
        case CURLE_RECV_ERROR:
        case CURLE_SSL_CONNECT_ERROR:
        case CURLE_HTTP2:
        case CURLE_HTTP2_STREAM:
            return true;
        default:
            return false;
    }
}

}  // namespace

struct Transfers::Running {
    Transfer transfer;
    CURL* easy = nullptr;
    bool has_begun = false;
    bool was_refused = false;
    bool has_wrong_range = false;   // the server sends another part than the requested one
    std::uint64_t error_bytes = 0;  // size of the body, if the answer is an error
    curl_slist* headers = nullptr;
    std::array<char, CURL_ERROR_SIZE> error{};

    Running() = default;
    Running(const Running&) = delete;
    Running& operator=(const Running&) = delete;
    ~Running() {
        if (easy != nullptr) curl_easy_cleanup(easy);
        curl_slist_free_all(headers);
    }
    // Returns true if the part begins at the requested byte: "Content-Range: bytes 500-999/1000".
    [[nodiscard]] bool has_right_range() const {
        curl_header* header = nullptr;
        if (curl_easy_header(easy, "Content-Range", 0, CURLH_HEADER, -1, &header) != CURLHE_OK) {
            return false;
        }
        return std::string_view{header->value}.starts_with(
            fmt::format("bytes {}-", transfer.from_byte));
    }
    [[nodiscard]] long status() const {
        long status = 0;
        curl_easy_getinfo(easy, CURLINFO_RESPONSE_CODE, &status);
        return status;
    }
    static std::size_t take_body(char* bytes, std::size_t size, std::size_t count, void* self) {
        auto& running = *static_cast<Running*>(self);
        const long status = running.status();
        const std::size_t length = size * count;
        // Drop the body of an error. If the body is too long, end the transfer.
        if (status != http_ok && status != http_partial) {
            running.error_bytes += length;
            return running.error_bytes <= most_error_bytes ? length : 0;
        }
        if (!running.has_begun) {
            running.has_begun = true;
            running.has_wrong_range = status == http_partial && !running.has_right_range();
            if (running.has_wrong_range) return 0;
            const std::uint64_t from = status == http_partial ? running.transfer.from_byte : 0;
            running.was_refused = !running.transfer.begin(from);
        }
        running.was_refused =
            running.was_refused ||
            !running.transfer.take(reinterpret_cast<const std::byte*>(bytes), length);
        return running.was_refused ? 0 : length;
    }
};

Transfers::Transfers(TransferOptions options) : options_(options) {}

Result<std::unique_ptr<Transfers>> Transfers::make(TransferOptions options) {
    curl_global_init(CURL_GLOBAL_DEFAULT);
    std::unique_ptr<Transfers> transfers(new Transfers(options));
    transfers->multi_ = curl_multi_init();
    if (transfers->multi_ == nullptr)
        return fail(ErrorCode::exhausted, "libcurl cannot be started");
    // Limit the connections that stay open, because over TLS each takes 4 MB, most of it for
    // certificates.
    curl_multi_setopt(transfers->multi_, CURLMOPT_MAXCONNECTS, static_cast<long>(options.parallel));
    return transfers;
}

Transfers::~Transfers() {
    for (const auto& running : running_)
        curl_multi_remove_handle(multi_, running->easy);
    running_.clear();
    if (multi_ != nullptr) curl_multi_cleanup(multi_);
}

void Transfers::add(Transfer transfer, std::chrono::milliseconds wait) {
    waiting_.push_back({std::move(transfer), Clock::now() + wait});
}

bool Transfers::start(Transfer transfer) {
    auto running = std::make_unique<Running>();
    running->transfer = std::move(transfer);
    running->easy = curl_easy_init();
    if (running->easy == nullptr) return false;
    CURL* const easy = running->easy;
    const std::string range = fmt::format("{}-", running->transfer.from_byte);
    const std::string agent = fmt::format("{}/{}", options_.agent, software_version);
    curl_easy_setopt(easy, CURLOPT_URL, running->transfer.url.c_str());
    curl_easy_setopt(easy, CURLOPT_PROTOCOLS_STR, "http,https");
    // If the request uses https, forbid redirects to http.
    const bool is_safe = running->transfer.url.starts_with("https");
    curl_easy_setopt(easy, CURLOPT_REDIR_PROTOCOLS_STR, is_safe ? "https" : "http,https");
    curl_easy_setopt(easy, CURLOPT_FOLLOWLOCATION, options_.most_redirects > 0 ? 1L : 0L);
    curl_easy_setopt(easy, CURLOPT_MAXREDIRS, options_.most_redirects);
    if (options_.is_direct || !options_.proxy.empty())
        curl_easy_setopt(easy, CURLOPT_PROXY, options_.proxy.c_str());
    if (!options_.ca_file.empty()) curl_easy_setopt(easy, CURLOPT_CAINFO, options_.ca_file.c_str());
    curl_easy_setopt(easy, CURLOPT_TIMEOUT, static_cast<long>(options_.longest.count()));
    curl_easy_setopt(easy, CURLOPT_USERAGENT, agent.c_str());
    curl_easy_setopt(easy, CURLOPT_NOSIGNAL, 1L);
    curl_easy_setopt(easy, CURLOPT_FILETIME, 1L);
    curl_easy_setopt(easy, CURLOPT_CONNECTTIMEOUT, connect_timeout_s);
    curl_easy_setopt(easy, CURLOPT_LOW_SPEED_LIMIT, slowest_bytes_per_s);
    curl_easy_setopt(easy, CURLOPT_LOW_SPEED_TIME, static_cast<long>(options_.stall.count()));
    curl_easy_setopt(easy, CURLOPT_ERRORBUFFER, running->error.data());
    curl_easy_setopt(easy, CURLOPT_WRITEFUNCTION, &Running::take_body);
    curl_easy_setopt(easy, CURLOPT_WRITEDATA, running.get());
    curl_easy_setopt(easy, CURLOPT_PRIVATE, running.get());
    if (running->transfer.from_byte > 0) curl_easy_setopt(easy, CURLOPT_RANGE, range.c_str());
    if (running->transfer.from_byte > 0 && !running->transfer.tag.empty()) {
        const std::string wanted = fmt::format("If-Match: {}", running->transfer.tag);
        running->headers = curl_slist_append(nullptr, wanted.c_str());
        curl_easy_setopt(easy, CURLOPT_HTTPHEADER, running->headers);
    }
    if (curl_multi_add_handle(multi_, easy) != CURLM_OK) return false;
    running_.push_back(std::move(running));
    return true;
}

void Transfers::start_due() {
    const auto now = Clock::now();
    for (auto one = waiting_.begin();
         one != waiting_.end() && running_.size() < static_cast<std::size_t>(options_.parallel);) {
        if (one->due > now) {
            ++one;
            continue;
        }
        Transfer transfer = std::move(one->transfer);
        one = waiting_.erase(one);
        const auto ended = transfer.ended;
        if (start(std::move(transfer))) continue;
        Transfer::Outcome none;
        none.may_be_tried_again = true;
        none.reason = "no transfer can be started";
        ended(none);
    }
}

void Transfers::finish_done() {
    int left = 0;
    while (const CURLMsg* const message = curl_multi_info_read(multi_, &left)) {
        if (message->msg != CURLMSG_DONE) continue;
        const CURLcode code = message->data.result;
        const auto found = std::ranges::find_if(
            running_, [&](const auto& one) { return one->easy == message->easy_handle; });
        if (found == running_.end()) continue;
        const std::unique_ptr<Running> running = std::move(*found);
        running_.erase(found);
        const long status = running->status();
        Transfer::Outcome outcome;
        outcome.good = code == CURLE_OK && (status == http_ok || status == http_partial);
        if (outcome.good && !running->has_begun) outcome.good = running->transfer.begin(0);
        curl_off_t modified = -1;
        curl_easy_getinfo(running->easy, CURLINFO_FILETIME_T, &modified);
        if (modified >= 0) outcome.modified = UtcTime{std::chrono::seconds{modified}};
        outcome.status = status;
        curl_off_t wait_s = 0;
        curl_easy_getinfo(running->easy, CURLINFO_RETRY_AFTER, &wait_s);
        outcome.retry_after =
            std::clamp<std::chrono::seconds>(std::chrono::seconds{wait_s}, {}, most_retry_after);
        if (!outcome.good) {
            outcome.may_be_tried_again =
                !running->was_refused && (is_passing(code, status) || status == http_range ||
                                          status == http_changed || running->has_wrong_range);
            outcome.is_refused = is_for_good(status);
            outcome.part_is_useless =
                status == http_range || status == http_changed || running->has_wrong_range;
            const char* const text =
                running->error[0] != '\0' ? running->error.data() : curl_easy_strerror(code);
            outcome.reason = running->has_wrong_range
                                 ? "the server answered with another part of the file"
                             : code == CURLE_OK || running->error_bytes > 0
                                 ? fmt::format("the server answered {}", status)
                                 : std::string{text};
        }
        curl_multi_remove_handle(multi_, running->easy);
        running->transfer.ended(outcome);
    }
}

int Transfers::wait_ms() const {
    if (!running_.empty() || waiting_.empty()) return longest_poll_ms;
    const auto first = std::ranges::min_element(waiting_, {}, &Waiting::due);
    const auto left =
        std::chrono::duration_cast<std::chrono::milliseconds>(first->due - Clock::now());
    return std::clamp(static_cast<int>(left.count()) + 1, 1, longest_poll_ms);
}

void Transfers::run(const std::atomic<bool>* stop, const std::function<void()>& turn) {
    while (!running_.empty() || !waiting_.empty()) {
        if (stop != nullptr && *stop) return;
        start_due();
        int going = 0;
        curl_multi_perform(multi_, &going);
        finish_done();
        if (turn) turn();
        if (running_.empty() && waiting_.empty()) return;
        curl_multi_poll(multi_, nullptr, 0, wait_ms(), nullptr);
    }
}

}  // namespace stormcellar::fetch
