// web/doors/s3/s3.h -- raw volumes as the objects of a bucket, for clients such as rclone, awscli,
// nexradaws and s3fs (docs/web/raw.md).
//
//   /s3/                               ListBuckets
//   /s3/BUCKET, /s3/BUCKET/            HeadBucket, GetBucketLocation (?location), ListObjects and
//                                      ListObjectsV2 (?list-type=2)
//   /s3/BUCKET/YYYY/MM/DD/STATION/NAME GetObject, HeadObject
//   /s3/BUCKET-chunks                  the same, with the chunks of volumes (web/doors/s3/chunks.h)
//
// Objects have the keys of the public buckets. The server ignores signatures, because everybody who
// reaches it may read. Errors are XML, with the codes of S3. An ETag contains '-', so that no
// client takes it for the MD5 of the object.
//
// Threads   Many threads may use it.
#pragma once

#include <memory>
#include <string>

#include "web/data/raw/raw_files.h"
#include "web/http/door.h"

namespace stormcellar::web {

inline constexpr std::string_view s3_namespace = "http://s3.amazonaws.com/doc/2006-03-01/";

// Returns a time such as "2022-03-17T00:12:33.000Z", in whole seconds as in Last-Modified.
[[nodiscard]] std::string s3_time(UtcTime time);
// Returns the tag of a listed object, with its quotes.
[[nodiscard]] std::string s3_tag(const RawVolume& volume);

class S3Door final : public Door {
  public:
    S3Door(std::shared_ptr<RawFiles> files, std::string bucket)
        : files_(std::move(files)), bucket_(std::move(bucket)) {}
    std::optional<Answer> answer_at_once(const Request& request) override;
    Answer answer(const Request& request) override;

  private:
    // Returns true for the bucket's name, and for its earlier name if it is the public bucket.
    [[nodiscard]] bool is_bucket(std::string_view name) const;
    // Returns true for the name of the bucket of chunks.
    [[nodiscard]] bool is_chunk_bucket(std::string_view name) const;
    [[nodiscard]] Answer buckets_answer() const;
    [[nodiscard]] Answer bucket_answer(const Request& request) const;
    [[nodiscard]] Answer list_answer(const Request& request) const;
    [[nodiscard]] Answer object_answer(const Request& request, std::string_view key) const;
    [[nodiscard]] Answer chunk_answer(const Request& request, std::string_view key) const;
    const std::shared_ptr<RawFiles> files_;
    const std::string bucket_;
};

}  // namespace stormcellar::web
