// web/http/stream_feed.h -- passes a Stream to libmicrohttpd, and suspends the connection while
// there is nothing to send.
//
// Threads   The server's thread reads; any thread may announce more.
#pragma once

#include <memory>

#include <sys/types.h>

#include "stormcellar/base/mutex.h"
#include "web/http/answer.h"

struct MHD_Connection;

namespace stormcellar::web {

class StreamFeed {
  public:
    StreamFeed(std::shared_ptr<Stream> stream, MHD_Connection* connection);
    StreamFeed(const StreamFeed&) = delete;
    StreamFeed& operator=(const StreamFeed&) = delete;

    // Call it once, after a shared_ptr holds this object.
    void begin(const std::shared_ptr<StreamFeed>& self);
    // Fills the buffer. Returns the number of bytes; 0 if the connection was suspended; or
    // MHD_CONTENT_READER_END_OF_STREAM.
    ssize_t read(char* buffer, std::size_t most);
    // Call it when the connection has closed.
    void leave();
    // Call it when the server stops. The stream then ends at the next read.
    void end();

  private:
    void more();
    // Resumes the connection, which wakes the server's thread.
    void resume_if_suspended() STORMCELLAR_REQUIRES(mutex_);

    const std::shared_ptr<Stream> stream_;
    MHD_Connection* const connection_;
    Mutex mutex_;
    bool is_suspended_ STORMCELLAR_GUARDED_BY(mutex_) = false;
    // True if the stream announced more after the last read began.
    bool was_told_ STORMCELLAR_GUARDED_BY(mutex_) = false;
    bool has_ended_ STORMCELLAR_GUARDED_BY(mutex_) = false;
    bool has_left_ STORMCELLAR_GUARDED_BY(mutex_) = false;
};

}  // namespace stormcellar::web
