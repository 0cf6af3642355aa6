// web/http/response.h -- makes a response of libmicrohttpd from an Answer.
//
// Threads   Pure, except that it reads files.
#pragma once

#include <memory>

#include "service/http_daemon.h"
#include "web/http/answer.h"
#include "web/http/stream_feed.h"

namespace stormcellar::web {

// Makes the response. Sets `feed` if the body is a stream, but not for HEAD, which begins no
// stream. Returns null if memory or descriptors have run out.
[[nodiscard]] HttpResponse make_response(const Answer& answer, Verb verb,
                                         MHD_Connection* connection,
                                         std::shared_ptr<StreamFeed>* feed);

}  // namespace stormcellar::web
