// web/http/response.h -- makes a response of libmicrohttpd from an Answer.
//
// Threads   Pure but for the files that it reads.
#pragma once

#include <memory>

#include "web/http/answer.h"
#include "web/http/stream_feed.h"

struct MHD_Connection;
struct MHD_Response;

namespace stormcellar::web {

struct ResponseDeleter {
    void operator()(MHD_Response* response) const;
};
using Response = std::unique_ptr<MHD_Response, ResponseDeleter>;

// `feed` is set if the body is a stream, which HEAD does not begin. Null if there is no memory or
// descriptor left.
[[nodiscard]] Response make_response(const Answer& answer, Verb verb, MHD_Connection* connection,
                                     std::shared_ptr<StreamFeed>* feed);

}  // namespace stormcellar::web
