#include "web/doors/s3/s3.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <utility>

#include <fmt/format.h>

#include "web/data/grids/text_answer.h"
#include "web/doors/raw/raw_answers.h"
#include "web/doors/s3/chunks.h"
#include "web/doors/s3/listing.h"
#include "web/doors/xml_writer.h"

namespace stormcellar::web {
namespace {

constexpr std::string_view public_bucket = "unidata-nexrad-level2";
// The name of the public bucket until 2025, which older clients use.
constexpr std::string_view earlier_public_bucket = "noaa-nexrad-level2";
constexpr std::string_view chunks_ending = "-chunks";

Answer s3_xml_answer(unsigned status, std::string text) {
    Answer answer = text_answer(status, "application/xml", std::move(text));
    answer.with("Cache-Control", "no-cache");
    return answer;
}

Answer s3_error(unsigned status, std::string_view code, std::string_view message,
                const Request& request) {
    XmlWriter xml;
    xml.open("Error").leaf("Code", code).leaf("Message", message).leaf("Resource", request.path);
    Answer answer = s3_xml_answer(status, xml.take());
    if (status == 503) answer.with("Retry-After", "5");
    return answer;
}

Answer s3_error(const Error& error, const Request& request) {
    if (error.code == ErrorCode::bad_argument)
        return s3_error(400, "InvalidArgument", error.message, request);
    if (status_of(error) == 503)
        return s3_error(503, "SlowDown", "The catalog cannot be read now.", request);
    return s3_error(500, "InternalError", "The catalog cannot be read.", request);
}

Answer missing_object(const RawFailure& failure, const Request& request) {
    switch (failure.why) {
        case RawMissing::changed:
        case RawMissing::trouble:
            return s3_error(503, "ServiceUnavailable",
                            "The file of this object cannot be given now.", request);
        case RawMissing::unknown:
        case RawMissing::gone:
            break;
    }
    return s3_error(404, "NoSuchKey", "The specified key does not exist.", request);
}

Answer s3_object_answer(const Request& request, Entity entity) {
    const std::uint64_t size = size_of(entity.bytes);
    Answer answer = answer_with(request, std::move(entity));
    if (answer.status == 416) {
        Answer error =
            s3_error(416, "InvalidRange", "The object has no byte in this range.", request);
        return error.with("Content-Range", fmt::format("bytes */{}", size));
    }
    if (answer.status == 412)
        return s3_error(412, "PreconditionFailed", "The object is not the one asked for.", request);
    return answer;
}

// Parameters that ask for something other than a list or the bytes of an object.
constexpr std::array<std::string_view, 20> other_resources = {
    "accelerate", "acl",      "analytics", "attributes",   "cors",    "encryption",  "inventory",
    "lifecycle",  "logging",  "metrics",   "notification", "policy",  "replication", "tagging",
    "torrent",    "uploadId", "uploads",   "versions",     "website", "object-lock"};

std::optional<Answer> refused_resource(const Request& request) {
    for (const auto& [name, value] : request.query) {
        if (std::ranges::count(other_resources, name) > 0) {
            return s3_error(501, "NotImplemented",
                            fmt::format("This server knows nothing of \"{}\".", name), request);
        }
    }
    return std::nullopt;
}

// The path after /s3/: a bucket, and a key if a slash follows the bucket.
struct S3Path {
    std::string_view bucket, key;
};
S3Path s3_path_of(std::string_view path) {
    path.remove_prefix(std::min(path.find('/', 1), path.size()));
    while (path.starts_with('/'))
        path.remove_prefix(1);
    const std::size_t slash = std::min(path.find('/'), path.size());
    return {path.substr(0, slash), path.substr(std::min(slash + 1, path.size()))};
}

}  // namespace

std::string s3_time(UtcTime time) {
    std::string text = format_utc(std::chrono::floor<std::chrono::seconds>(time));
    text.pop_back();
    return text + ".000Z";
}

std::string s3_tag(const RawVolume& volume) {
    if (!volume.tag.empty()) return volume.tag;
    return fmt::format("\"growing-{}-{}\"", volume.size_bytes,
                       volume.modified.time_since_epoch().count());
}

std::optional<Answer> S3Door::answer_at_once(const Request& request) {
    const S3Path path = s3_path_of(request.path);
    if (!is_bucket(path.bucket) || path.key.empty() || refused_resource(request)) {
        return std::nullopt;
    }
    const auto key = parse_s3_key(path.key);
    if (!key) return std::nullopt;
    auto answer = volume_answer_at_once(request, *files_, key->station, key->name);
    // Leave refusals to object_answer(), which words them as S3 does.
    return answer && answer->status < 400 ? std::move(answer) : std::nullopt;
}

bool S3Door::is_bucket(std::string_view name) const {
    return name == bucket_ || (bucket_ == public_bucket && name == earlier_public_bucket);
}

bool S3Door::is_chunk_bucket(std::string_view name) const {
    return name.ends_with(chunks_ending) &&
           is_bucket(name.substr(0, name.size() - chunks_ending.size()));
}

Answer S3Door::answer(const Request& request) {
    const S3Path path = s3_path_of(request.path);
    if (path.bucket.empty()) return buckets_answer();
    const bool has_chunks = is_chunk_bucket(path.bucket);
    if (!has_chunks && !is_bucket(path.bucket)) {
        return s3_error(404, "NoSuchBucket", "The specified bucket does not exist.", request);
    }
    if (auto refused = refused_resource(request)) return *std::move(refused);
    if (path.key.empty()) return bucket_answer(request);
    return has_chunks ? chunk_answer(request, path.key) : object_answer(request, path.key);
}

Answer S3Door::buckets_answer() const {
    XmlWriter xml;
    xml.open("ListAllMyBucketsResult", {{"xmlns", s3_namespace}});
    xml.open("Owner").leaf("ID", "stormcellar").leaf("DisplayName", "stormcellar").close();
    xml.open("Buckets").open("Bucket");
    xml.leaf("Name", bucket_).leaf("CreationDate", "1991-06-05T00:00:00.000Z");
    return s3_xml_answer(200, xml.take());
}

Answer S3Door::bucket_answer(const Request& request) const {
    if (request.parameter("location")) {
        XmlWriter xml;
        // An empty value means us-east-1, the region of the public bucket.
        xml.leaf("LocationConstraint", "", {{"xmlns", s3_namespace}});
        return s3_xml_answer(200, xml.take());
    }
    if (request.parameter("versioning")) {
        XmlWriter xml;
        xml.leaf("VersioningConfiguration", "", {{"xmlns", s3_namespace}});
        return s3_xml_answer(200, xml.take());
    }
    if (request.verb == Verb::head) {
        Answer answer;
        return answer.with("x-amz-bucket-region", "us-east-1");
    }
    return list_answer(request);
}

Answer S3Door::list_answer(const Request& request) const {
    const auto options = read_s3_list_options(request);
    if (!options) return s3_error(options.error(), request);
    const std::string_view bucket = s3_path_of(request.path).bucket;
    S3Keys volumes(files_);
    S3ChunkKeys chunks(files_);
    S3Walk& keys = is_chunk_bucket(bucket) ? static_cast<S3Walk&>(chunks) : volumes;
    const auto listing = list_s3_objects(keys, *options);
    if (!listing) return s3_error(listing.error(), request);
    return text_answer_to(request, "application/xml", s3_listing_xml(bucket, *options, *listing));
}

Answer S3Door::object_answer(const Request& request, std::string_view text) const {
    const auto key = parse_s3_key(text);
    if (!key) return missing_object({}, request);
    const auto opened = files_->open(key->station, key->name);
    if (!opened) return missing_object(opened.error(), request);
    return s3_object_answer(request, entity_of(*opened));
}

Answer S3Door::chunk_answer(const Request& request, std::string_view text) const {
    const auto key = parse_s3_chunk_key(text);
    if (!key) return missing_object({}, request);
    RawRange range;
    range.from = key->start;
    range.to = key->start + std::chrono::milliseconds{999};
    const auto volumes = files_->list(key->station, range);
    if (!volumes) return s3_error(volumes.error(), request);
    for (const RawVolume& volume : *volumes) {
        if (volume.number != key->volume) continue;
        const auto opened = files_->open(volume.station, volume.name);
        if (!opened) return missing_object(opened.error(), request);
        for (const VolumeChunk& chunk : chunks_of(*opened)) {
            if (chunk.number != key->number || chunk.kind != key->kind) continue;
            Entity entity = entity_of(*opened);
            entity.bytes = part_of(opened->bytes, chunk.offset, chunk.size);
            entity.etag = chunk_tag(opened->volume, chunk);
            return s3_object_answer(request, std::move(entity));
        }
    }
    return missing_object({}, request);
}

}  // namespace stormcellar::web
