#include "daemon/status/rejected_paths.h"

#include <span>
#include <string>
#include <utility>
#include <variant>

#include "base/checksum.h"

namespace stormcellar::daemon {
namespace {

using pipeline::IngestResult;

std::uint64_t hash_of(const std::string& text) {
    return xxh3_64(std::as_bytes(std::span{text}));
}

std::uint64_t hash_of_reason(ErrorCode code, const std::string& reason) {
    std::string text(1, static_cast<char>(code));
    for (const char c : reason)
        if (c < '0' || c > '9') text += c;
    return hash_of(text);
}

}  // namespace

bool RejectedPaths::is_news(const std::filesystem::path& path,
                            const pipeline::IngestOutcome& outcome) {
    const std::uint64_t name = hash_of(path.native());
    if (outcome.result() == IngestResult::gridded || outcome.result() == IngestResult::vanished)
        reasons_.erase(name);
    const auto* rejected = std::get_if<pipeline::ended::Rejected>(&outcome.ending);
    if (rejected == nullptr) return true;
    const std::uint64_t reason = hash_of_reason(rejected->with, outcome.reason);
    const auto [known, is_new] = reasons_.try_emplace(name, reason);
    if (!is_new) return std::exchange(known->second, reason) != reason;
    order_.push_back(name);
    if (order_.size() > most_) {
        reasons_.erase(order_.front());
        order_.pop_front();
    }
    return true;
}

}  // namespace stormcellar::daemon
