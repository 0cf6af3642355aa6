// web/http/response.h -- makes a response of libmicrohttpd from an Answer.
//
// Threads   Pure, except that it reads files.
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

// Makes the response. It sets `feed` if the body is a stream, unless the verb is HEAD, which does
// not begin one. Returns null if memory or descriptors have run out.
[[nodiscard]] Response make_response(const Answer& answer, Verb verb, MHD_Connection* connection,
                                     std::shared_ptr<StreamFeed>* feed);

}  // namespace stormcellar::web
