#include "web/doors/s3/listing.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/parse_number.h"
#include "web/doors/s3/s3.h"
#include "web/doors/xml_writer.h"

namespace stormcellar::web {
namespace {

constexpr std::size_t most_keys = 1000, longest_key = 1024;

std::string text_or_nothing(const Request& request, std::string_view name) {
    return std::string{request.parameter(name).value_or("")};
}

// Returns the smallest text that is greater than all texts that begin with these bytes.
std::string behind_all(std::string text) {
    while (!text.empty() && static_cast<unsigned char>(text.back()) == 0xFF)
        text.pop_back();
    if (!text.empty()) text.back() = static_cast<char>(static_cast<unsigned char>(text.back()) + 1);
    return text;
}

// Returns the key up to the first delimiter after the prefix. Returns an empty text if there is
// none.
std::string common_prefix_of(std::string_view key, const S3ListOptions& options) {
    if (options.delimiter.empty()) return {};
    const std::size_t at = key.find(options.delimiter, options.prefix.size());
    if (at == key.npos) return {};
    return std::string{key.substr(0, at + options.delimiter.size())};
}

// Returns a key as listings show it. With encoding-type=url, it is encoded, except for its slashes.
std::string encoded_key(std::string_view key, const S3ListOptions& options) {
    if (!options.encodes_keys) return std::string{key};
    std::string out;
    while (!key.empty()) {
        const std::size_t slash = std::min(key.find('/'), key.size());
        out += encoded(key.substr(0, slash));
        if (slash < key.size()) out += '/';
        key.remove_prefix(std::min(slash + 1, key.size()));
    }
    return out;
}

// Collects the entries of one listing.
class S3Lister {
  public:
    S3Lister(S3Walk& keys, const S3ListOptions& options) : keys_(keys), options_(options) {
        place_ = std::max(options.prefix, options.after);
        end_ = behind_all(options.prefix);
        // If the previous answer ended with a common prefix, skip all keys below it.
        if (!options.after.empty()) {
            const bool is_prefix = options.after.starts_with(options.prefix) &&
                                   common_prefix_of(options.after, options) == options.after;
            place_ = std::max(place_, is_prefix ? behind_all(options.after)
                                                : options.after + std::string(1, '\0'));
        }
    }

    Result<S3Listing> list() {
        while (!is_over_) {
            // If the list has common prefixes, one key of each is enough.
            const std::size_t wanted = skips_ ? 1 : options_.most - count() + 1;
            auto batch = keys_.between(place_, end_, wanted);
            if (!batch) return pass_on(batch);
            if (batch->empty()) break;
            if (Status taken = take(std::move(*batch)); !taken) return pass_on(taken);
        }
        return std::move(listing_);
    }

  private:
    [[nodiscard]] std::size_t count() const {
        return listing_.objects.size() + listing_.common_prefixes.size();
    }
    Status take(std::vector<S3Object> batch) {
        for (S3Object& object : batch) {
            if (!object.key.starts_with(options_.prefix)) {
                is_over_ = true;
                return {};
            }
            if (count() == options_.most) {
                listing_.next = last_;
                is_over_ = true;
                return {};
            }
            if (const std::string common = common_prefix_of(object.key, options_);
                !common.empty()) {
                listing_.common_prefixes.push_back(common);
                last_ = common;
                place_ = behind_all(common);
                skips_ = true;
                return {};
            }
            if (Status complete = keys_.complete(object); !complete) return complete;
            last_ = object.key;
            place_ = object.key + std::string(1, '\0');
            listing_.objects.push_back(std::move(object));
            skips_ = false;
        }
        return {};
    }

    S3Walk& keys_;
    const S3ListOptions& options_;
    S3Listing listing_;
    std::string place_, end_, last_;
    bool is_over_ = false;
    bool skips_ = !options_.delimiter.empty();
};

void write_object(XmlWriter& xml, const S3Object& object, const S3ListOptions& options) {
    xml.open("Contents");
    xml.leaf("Key", encoded_key(object.key, options));
    xml.leaf("LastModified", s3_time(object.volume.modified));
    xml.leaf("ETag", s3_tag(object.volume));
    xml.leaf("Size", fmt::format("{}", object.volume.size_bytes));
    if (options.names_owner || !options.is_version_2)
        xml.open("Owner").leaf("ID", "stormcellar").leaf("DisplayName", "stormcellar").close();
    xml.leaf("StorageClass", "STANDARD");
    xml.close();
}

}  // namespace

Result<S3ListOptions> read_s3_list_options(const Request& request) {
    S3ListOptions options;
    options.is_version_2 = request.parameter("list-type") == "2";
    options.prefix = text_or_nothing(request, "prefix");
    options.delimiter = text_or_nothing(request, "delimiter");
    if (options.is_version_2) {
        options.token = text_or_nothing(request, "continuation-token");
        options.start_after = text_or_nothing(request, "start-after");
        options.after = options.token.empty() ? options.start_after : options.token;
        options.names_owner = request.parameter("fetch-owner") == "true";
    } else {
        options.after = text_or_nothing(request, "marker");
    }
    for (const std::string& text : {options.prefix, options.delimiter, options.after}) {
        if (text.size() > longest_key)
            return fail(ErrorCode::bad_argument, "A key has at most {} bytes.", longest_key);
    }
    if (const auto text = request.parameter("max-keys"); text && !text->empty()) {
        const auto most = parse_number<decltype(options.most)>(*text);
        if (!most) return fail(ErrorCode::bad_argument, "max-keys must be a number from 0 on.");
        options.most = std::min(*most, most_keys);
    }
    if (const auto encoding = request.parameter("encoding-type"); encoding && !encoding->empty()) {
        if (*encoding != "url") return fail(ErrorCode::bad_argument, "encoding-type must be url.");
        options.encodes_keys = true;
    }
    return options;
}

Result<S3Listing> list_s3_objects(S3Walk& keys, const S3ListOptions& options) {
    if (options.most == 0) return S3Listing{};
    return S3Lister(keys, options).list();
}

std::string s3_listing_xml(std::string_view bucket, const S3ListOptions& options,
                           const S3Listing& listing) {
    XmlWriter xml;
    xml.open("ListBucketResult", {{"xmlns", s3_namespace}});
    xml.leaf("Name", bucket);
    xml.leaf("Prefix", encoded_key(options.prefix, options));
    if (!options.delimiter.empty()) xml.leaf("Delimiter", encoded_key(options.delimiter, options));
    xml.leaf("MaxKeys", fmt::format("{}", options.most));
    if (options.encodes_keys) xml.leaf("EncodingType", "url");
    xml.leaf("IsTruncated", listing.next.empty() ? "false" : "true");
    if (options.is_version_2) {
        xml.leaf("KeyCount",
                 fmt::format("{}", listing.objects.size() + listing.common_prefixes.size()));
        if (!options.token.empty()) xml.leaf("ContinuationToken", options.token);
        if (!options.start_after.empty())
            xml.leaf("StartAfter", encoded_key(options.start_after, options));
        if (!listing.next.empty()) xml.leaf("NextContinuationToken", listing.next);
    } else {
        xml.leaf("Marker", encoded_key(options.after, options));
        if (!listing.next.empty()) xml.leaf("NextMarker", encoded_key(listing.next, options));
    }
    for (const S3Object& object : listing.objects)
        write_object(xml, object, options);
    for (const std::string& prefix : listing.common_prefixes)
        xml.open("CommonPrefixes").leaf("Prefix", encoded_key(prefix, options)).close();
    return xml.take();
}

}  // namespace stormcellar::web
