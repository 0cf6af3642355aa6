// web/http/stream_feed.h -- passes a Stream to libmicrohttpd, and holds its connection still while
// there is nothing to send.
//
// Threads   The server's thread reads; any thread may say that there is more.
#pragma once

#include <memory>
#include <mutex>

#include <sys/types.h>

#include "web/http/answer.h"

struct MHD_Connection;

namespace stormcellar::web {

class StreamFeed {
  public:
    StreamFeed(std::shared_ptr<Stream> stream, MHD_Connection* connection);
    StreamFeed(const StreamFeed&) = delete;
    StreamFeed& operator=(const StreamFeed&) = delete;

    // Call once, when it is held by a shared_ptr.
    void begin(const std::shared_ptr<StreamFeed>& self);
    // Fills the buffer: the number of bytes, 0 if the connection was suspended, or
    // MHD_CONTENT_READER_END_OF_STREAM.
    ssize_t read(char* buffer, std::size_t most);
    // The connection is closed.
    void leave();
    // The server stops: the stream ends with the next read.
    void end();

  private:
    void more();

    const std::shared_ptr<Stream> stream_;
    MHD_Connection* const connection_;
    std::mutex mutex_;
    bool is_suspended_ = false;
    bool was_told_ = false;  // that there is more, since the last read began
    bool has_ended_ = false, has_left_ = false;
};

}  // namespace stormcellar::web
