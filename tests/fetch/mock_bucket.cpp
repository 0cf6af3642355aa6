#include "tests/fetch/mock_bucket.h"

#include <algorithm>
#include <functional>
#include <string_view>

#include <fmt/format.h>

namespace stormcellar::fetch {
namespace {

using Way = testing::Reply::Way;

constexpr std::string_view modified = "Sun, 01 Jan 2017 03:07:30 GMT";

std::string tag_of(const std::string& contents) {
    return fmt::format("\"{:x}\"", std::hash<std::string>{}(contents));
}

}  // namespace

void MockBucket::put(const std::string& key, std::string contents) {
    const std::scoped_lock lock(mutex_);
    objects_[key] = std::move(contents);
}

void MockBucket::fail_next(const std::string& key, std::vector<Fault> faults) {
    const std::scoped_lock lock(mutex_);
    faults_[key].assign(faults.begin(), faults.end());
}

std::size_t MockBucket::asked(const std::string& key) const {
    const std::scoped_lock lock(mutex_);
    const auto found = asked_.find(key);
    return found == asked_.end() ? 0 : found->second;
}

std::size_t MockBucket::last_from(const std::string& key) const {
    const std::scoped_lock lock(mutex_);
    const auto found = last_from_.find(key);
    return found == last_from_.end() ? 0 : found->second;
}

MockBucket::Fault MockBucket::next_fault(const std::string& key) {
    const std::scoped_lock lock(mutex_);
    ++asked_[key];
    auto& due = faults_[key];
    if (due.empty()) return Fault::none;
    const Fault fault = due.front();
    due.pop_front();
    return fault;
}

std::string MockBucket::listing(const std::string& prefix, const std::string& token) {
    const std::scoped_lock lock(mutex_);
    std::string entries;
    std::size_t count = 0;
    std::string next;
    for (auto one = objects_.lower_bound(std::max(prefix, token)); one != objects_.end(); ++one) {
        if (!one->first.starts_with(prefix)) break;
        if (count++ == page_) {
            next = one->first;
            break;
        }
        entries += fmt::format(
            "<Contents><Key>{}</Key><LastModified>2017-01-01T03:07:30.000Z"
            "</LastModified><ETag>{}</ETag><Size>{}</Size></Contents>",
            one->first, tag_of(one->second), one->second.size());
    }
    return fmt::format(
        "<?xml version=\"1.0\"?><ListBucketResult><IsTruncated>{}</IsTruncated>{}{}"
        "</ListBucketResult>",
        !next.empty(), entries,
        next.empty() ? ""
                     : fmt::format("<NextContinuationToken>{}</"
                                   "NextContinuationToken>",
                                   next));
}

testing::Reply MockBucket::answer(const testing::Asked& asked) {
    const bool lists = asked.path.find('?') != std::string::npos;
    const std::string key = lists ? asked.parameter("prefix") : asked.key();
    const Fault fault = next_fault(key);
    if (fault == Fault::unavailable) return {503, "none"};
    if (fault == Fault::missing) return {404, "none"};
    if (fault == Fault::no_xml) return {200, "<html>not now</html>"};
    if (fault == Fault::endless_error) return {403, "", "", Way::endless};
    return lists ? testing::Reply{200, listing(key, asked.parameter("continuation-token"))}
                 : object(asked, fault);
}

testing::Reply MockBucket::object(const testing::Asked& asked, Fault fault) {
    const std::scoped_lock lock(mutex_);
    const auto found = objects_.find(asked.key());
    if (found == objects_.end()) return {404, "none"};
    std::string body = found->second;
    const std::string range = asked.header("Range"), match = asked.header("If-Match");
    const std::size_t from = range.empty() ? 0 : std::stoul(range.substr(range.find('=') + 1));
    last_from_[found->first] = from;
    if (fault == Fault::changed || (!match.empty() && match != tag_of(body))) return {412, ""};
    if (fault == Fault::longer) body += "and more";
    if (fault == Fault::shorter) body.resize(body.size() / 2);
    const std::string rest = body.substr(std::min(from, body.size()));
    const std::size_t said = fault == Fault::other_part ? 0 : from;
    return {from > 0 ? 206 : 200, rest,
            fmt::format("Last-Modified: {}\r\nContent-Range: bytes {}-{}/{}\r\n", modified, said,
                        said + rest.size() - 1, body.size()),
            fault == Fault::cut       ? Way::cut
            : fault == Fault::stalled ? Way::hangs
                                      : Way::whole};
}

}  // namespace stormcellar::fetch
