#include "fetch/feed/bucket_client.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "fetch/bucket/transfers.h"

namespace stormcellar::feed {
namespace {

// Number of connections at the same time. Each takes memory, most of it for certificates.
constexpr int parallel = 12;
constexpr std::chrono::seconds longest_transfer{60};
constexpr std::uint64_t most_page_bytes = std::uint64_t{1} << 20;
// A page has 1,000 keys. In each round of the volume numbers, a directory gets at most 999 chunks.
constexpr std::size_t most_pages = 4;
constexpr std::size_t longest_token = 1024;

ErrorCode code_of(const fetch::Transfer::Outcome& outcome) {
    if (outcome.status == 403) return ErrorCode::permission;
    if (outcome.is_refused) return ErrorCode::not_found;
    return outcome.may_be_tried_again ? ErrorCode::busy : ErrorCode::io;
}

}  // namespace

struct BucketClient::Pages {
    fetch::ListingQuestion question;
    fetch::ListingPage all;
    std::size_t count = 0;
    std::function<void(Result<fetch::ListingPage>)> taken;
};

BucketClient::BucketClient(std::string bucket) : bucket_(std::move(bucket)) {}

BucketClient::~BucketClient() = default;

Result<std::unique_ptr<BucketClient>> BucketClient::open(const FeedConfig& config) {
    std::unique_ptr<BucketClient> client(new BucketClient(config.bucket));
    auto transfers = fetch::Transfers::make({.parallel = parallel,
                                             .stall = config.stall,
                                             .longest = longest_transfer,
                                             .most_redirects = 0,
                                             .proxy = config.proxy,
                                             .is_direct = config.proxy.empty(),
                                             .ca_file = config.ca_file,
                                             .agent = "stormcellar-feed"});
    if (!transfers) return pass_on(transfers);
    client->transfers_ = std::move(*transfers);
    return client;
}

void BucketClient::run(const std::atomic<bool>& stop, const std::function<void()>& turn) {
    transfers_->run(&stop, turn);
}

void BucketClient::ask(std::string url, std::uint64_t most, std::chrono::milliseconds wait,
                       std::function<void(Result<Bytes>)> taken) {
    struct Body {
        Bytes bytes;
        bool is_too_long = false;
    };
    const auto body = std::make_shared<Body>();
    fetch::Transfer transfer;
    transfer.begin = [](std::uint64_t) { return true; };
    transfer.take = [body, most](const std::byte* bytes, std::size_t count) {
        body->is_too_long = body->bytes.size() + count > most;
        if (!body->is_too_long) body->bytes.insert(body->bytes.end(), bytes, bytes + count);
        return !body->is_too_long;
    };
    transfer.ended = [this, body, most, url,
                      taken = std::move(taken)](const fetch::Transfer::Outcome& outcome) {
        retry_after_ = outcome.retry_after;
        if (outcome.good) return taken(std::move(body->bytes));
        if (body->is_too_long) {
            return taken(
                fail(ErrorCode::over_budget, "{}: the answer has more than {} bytes", url, most));
        }
        taken(fail(code_of(outcome), "{}: {}", url, outcome.reason));
    };
    transfer.url = std::move(url);
    transfers_->add(std::move(transfer), wait);
}

void BucketClient::get(const std::string& key, std::uint64_t size,
                       std::function<void(Result<Bytes>)> taken) {
    const std::string url = fetch::object_url(bucket_, key);
    ask(url, size, {}, [size, url, taken = std::move(taken)](Result<Bytes> body) {
        if (body && body->size() < size) {
            return taken(fail(ErrorCode::truncated, "{}: {} bytes came instead of {}", url,
                              body->size(), size));
        }
        taken(std::move(body));
    });
}

void BucketClient::list(fetch::ListingQuestion question, std::chrono::milliseconds wait,
                        std::function<void(Result<fetch::ListingPage>)> taken) {
    auto pages = std::make_shared<Pages>();
    pages->question = std::move(question);
    pages->taken = std::move(taken);
    ask_page(std::move(pages), wait);
}

void BucketClient::ask_page(std::shared_ptr<Pages> pages, std::chrono::milliseconds wait) {
    std::string url = fetch::listing_url(bucket_, pages->question);
    ask(std::move(url), most_page_bytes, wait,
        [this, pages](Result<Bytes> body) { take_page(pages, std::move(body)); });
}

void BucketClient::take_page(const std::shared_ptr<Pages>& pages, Result<Bytes> body) {
    const std::string& prefix = pages->question.prefix;
    if (!body) return pages->taken(pass_on(body));
    auto page = fetch::parse_listing(*body);
    const auto most = static_cast<std::size_t>(pages->question.most_keys);
    if (!page)
        return pages->taken(fail(ErrorCode::corrupt, "{}: {}", prefix, page.error().message));
    if (page->objects.size() + page->folders.size() > most ||
        page->next_token.size() > longest_token) {
        return pages->taken(
            fail(ErrorCode::over_budget, "{}: the listing names more than was asked for", prefix));
    }
    fetch::ListingPage& all = pages->all;
    std::ranges::move(page->objects, std::back_inserter(all.objects));
    std::ranges::move(page->folders, std::back_inserter(all.folders));
    const bool is_probe = pages->question.most_keys < fetch::ListingQuestion{}.most_keys;
    if (page->next_token.empty() || is_probe) return pages->taken(std::move(all));
    if (++pages->count == most_pages)
        return pages->taken(fail(ErrorCode::over_budget, "{}: the listing does not end", prefix));
    pages->question.token = std::move(page->next_token);
    ask_page(pages, {});
}

}  // namespace stormcellar::feed
