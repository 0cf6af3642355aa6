// web/doors/s3/listing.h -- answers ListObjects and ListObjectsV2 for the volumes of a bucket.
//
// Threads   Functions without state.
// Errors    bad_argument for parameters that make no sense, and those of S3Walk.
#pragma once

#include <string>
#include <vector>

#include "web/doors/s3/keys.h"
#include "web/http/request.h"

namespace stormcellar::web {

struct S3ListOptions {
    bool is_version_2 = false;
    std::string prefix, delimiter;
    std::size_t most = 1000;
    // The list begins after this key. If this is a common prefix, the list also leaves out all keys
    // below it.
    std::string after;
    std::string token;  // of version 2, as the request has it
    std::string start_after;
    bool encodes_keys = false;
    bool names_owner = false;
};
[[nodiscard]] Result<S3ListOptions> read_s3_list_options(const Request& request);

struct S3Listing {
    std::vector<S3Object> objects;
    std::vector<std::string> common_prefixes;
    std::string next;  // the last entry if more follow; else empty
};
[[nodiscard]] Result<S3Listing> list_s3_objects(S3Walk& keys, const S3ListOptions& options);

// Returns the document ListBucketResult.
[[nodiscard]] std::string s3_listing_xml(std::string_view bucket, const S3ListOptions& options,
                                         const S3Listing& listing);

}  // namespace stormcellar::web
