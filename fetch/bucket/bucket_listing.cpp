#include "fetch/bucket/bucket_listing.h"

#include <algorithm>
#include <charconv>

#include <fmt/format.h>
#include <pugixml.hpp>

namespace stormcellar::fetch {
namespace {

// Encodes a text for a URL. Keeps slashes, which separate the parts of a key, if that is requested.
std::string percent_encoded(std::string_view text, bool keep_slashes) {
    std::string encoded;
    for (const char c : text) {
        const bool plain = (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') ||
                           (c >= '0' && c <= '9') || c == '-' || c == '_' || c == '.' || c == '~' ||
                           (keep_slashes && c == '/');
        if (plain) {
            encoded += c;
        } else {
            encoded += fmt::format("%{:02X}", static_cast<unsigned char>(c));
        }
    }
    return encoded;
}

std::string_view without_slash(std::string_view source) {
    while (source.ends_with('/'))
        source.remove_suffix(1);
    return source;
}

std::optional<BucketObject> read_object(const pugi::xml_node& node) {
    BucketObject object;
    object.key = node.child_value("Key");
    const std::string_view size = node.child_value("Size");
    const char* const end = size.data() + size.size();
    const auto [stopped, error] = std::from_chars(size.data(), end, object.size_bytes);
    if (object.key.empty() || error != std::errc{} || stopped != end) return std::nullopt;
    object.tag = node.child_value("ETag");
    if (const auto time = parse_utc(node.child_value("LastModified"), {})) object.modified = *time;
    return object;
}

}  // namespace

Result<ListingPage> parse_listing(std::span<const std::byte> xml) {
    pugi::xml_document document;
    const auto parsed = document.load_buffer(xml.data(), xml.size());
    const pugi::xml_node root = document.child("ListBucketResult");
    if (!parsed || !root)
        return fail(ErrorCode::corrupt, "the answer is not the listing of a bucket");
    ListingPage page;
    for (const pugi::xml_node& node : root.children("Contents")) {
        auto object = read_object(node);
        if (!object) return fail(ErrorCode::corrupt, "the listing names an object without a size");
        page.objects.push_back(std::move(*object));
    }
    for (const pugi::xml_node& node : root.children("CommonPrefixes"))
        page.folders.emplace_back(node.child_value("Prefix"));
    if (std::string_view{root.child_value("IsTruncated")} != "true") return page;
    page.next_token = root.child_value("NextContinuationToken");
    if (page.next_token.empty()) {
        return fail(ErrorCode::corrupt,
                    "the listing has more pages and does not say where they are");
    }
    return page;
}

std::string listing_url(std::string_view source, std::string_view prefix, std::string_view token) {
    std::string url = fmt::format("{}/?list-type=2&prefix={}", without_slash(source),
                                  percent_encoded(prefix, false));
    if (!token.empty()) url += "&continuation-token=" + percent_encoded(token, false);
    return url;
}

std::string listing_url(std::string_view source, const ListingQuestion& question) {
    std::string url = listing_url(source, question.prefix, question.token);
    if (!question.start_after.empty())
        url += "&start-after=" + percent_encoded(question.start_after, false);
    if (question.by_folders) url += "&delimiter=%2F";
    if (question.most_keys != ListingQuestion{}.most_keys)
        url += fmt::format("&max-keys={}", question.most_keys);
    return url;
}

std::string object_url(std::string_view source, std::string_view key) {
    return fmt::format("{}/{}", without_slash(source), percent_encoded(key, true));
}

std::vector<std::string> prefixes_of(const std::vector<std::string>& stations, UtcTime from,
                                     UtcTime to) {
    using namespace std::chrono;
    std::vector<std::string> prefixes;
    for (auto day = floor<days>(from); day <= floor<days>(to); day += days{1}) {
        const year_month_day date{day};
        for (const std::string& station : stations) {
            prefixes.push_back(fmt::format("{:04}/{:02}/{:02}/{}/", static_cast<int>(date.year()),
                                           static_cast<unsigned>(date.month()),
                                           static_cast<unsigned>(date.day()), station));
        }
    }
    return prefixes;
}

std::string_view name_of_key(std::string_view key) {
    return key.substr(key.rfind('/') + 1);
}

std::optional<UtcTime> start_in_name(std::string_view name) {
    constexpr std::size_t station = 4;
    constexpr std::size_t time = 15;
    if (name.size() < station + time) return std::nullopt;
    const auto start = parse_compact(name.substr(station, time));
    if (!start) return std::nullopt;
    return *start;
}

bool is_metadata_name(std::string_view name) {
    return name.ends_with("_MDM");
}

}  // namespace stormcellar::fetch
