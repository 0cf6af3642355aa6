// web/data/grids/text_answer.h -- answers with a text that is made for each request.
//
// Threads   Pure functions.
#pragma once

#include <string>

#include "web/http/answer.h"

namespace stormcellar::web {

// A smaller text is not compressed, because it fits into one packet together with the headers.
inline constexpr std::size_t least_compressed_text = 1024;

// Answers with the text, and an ETag made of its bytes. Compresses a text of over a kilobyte if the
// client accepts a coding. The client must revalidate each use. Adds `headers` to the answer.
// Errors: 503 if there is no memory for compressing.
[[nodiscard]] Answer text_answer_to(const Request& request, std::string content_type,
                                    std::string text, Fields headers = {});

}  // namespace stormcellar::web
