#include "web/http/stream_feed.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include <microhttpd.h>

namespace stormcellar::web {

StreamFeed::StreamFeed(std::shared_ptr<Stream> stream, MHD_Connection* connection)
    : stream_(std::move(stream)), connection_(connection) {}

void StreamFeed::begin(const std::shared_ptr<StreamFeed>& self) {
    stream_->on_more([weak = std::weak_ptr<StreamFeed>(self)] {
        if (const auto feed = weak.lock()) feed->more();
    });
}

void StreamFeed::resume_if_suspended() {
    if (!is_suspended_ || has_left_) return;
    is_suspended_ = false;
    MHD_resume_connection(connection_);
}

void StreamFeed::more() {
    const MutexLock lock(mutex_);
    was_told_ = true;
    resume_if_suspended();
}

ssize_t StreamFeed::read(char* buffer, std::size_t most) {
    while (true) {
        {
            const MutexLock lock(mutex_);
            if (has_ended_) return MHD_CONTENT_READER_END_OF_STREAM;
            was_told_ = false;
        }
        const std::optional<std::string> bytes = stream_->read(most);
        if (!bytes) return MHD_CONTENT_READER_END_OF_STREAM;
        if (!bytes->empty()) {
            const std::size_t size = std::min(bytes->size(), most);
            std::memcpy(buffer, bytes->data(), size);
            return static_cast<ssize_t>(size);
        }
        const MutexLock lock(mutex_);
        if (was_told_ || has_ended_) continue;
        // Without a suspension, libmicrohttpd would ask again and again.
        is_suspended_ = true;
        MHD_suspend_connection(connection_);
        return 0;
    }
}

void StreamFeed::leave() {
    {
        const MutexLock lock(mutex_);
        has_left_ = true;
    }
    stream_->on_more(nullptr);
}

void StreamFeed::end() {
    const MutexLock lock(mutex_);
    has_ended_ = true;
    resume_if_suspended();
}

}  // namespace stormcellar::web
