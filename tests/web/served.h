// tests/web/served.h -- a server on loopback whose answers come from functions of a test.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <thread>
#include <utility>

#include <gtest/gtest.h>

#include "tests/web/raw_client.h"
#include "web/http/server.h"

namespace stormcellar::web {

class FunctionDoor : public Door {
  public:
    explicit FunctionDoor(std::function<Answer(const Request&)> make) : make_(std::move(make)) {}
    Answer answer(const Request& request) override { return make_(request); }

  private:
    std::function<Answer(const Request&)> make_;
};

class WebServer : public ::testing::Test {
  protected:
    void add(std::string path, std::function<Answer(const Request&)> make) {
        doors_->add(std::move(path), std::make_shared<FunctionDoor>(std::move(make)));
    }
    void add_body(std::string path, decltype(Answer::body) body) {
        add(std::move(path), [body = std::move(body)](const Request&) {
            Answer answer;
            answer.body = body;
            return answer;
        });
    }
    void start() {
        add("/", [](const Request& request) {
            return text_answer(200, "text/plain", "at " + request.path);
        });
        options_.listen = {{"127.0.0.1", 0}};
        auto opened = Server::open(options_, doors_);
        ASSERT_TRUE(opened) << opened.error().message;
        server_ = std::move(*opened);
        const std::string url = server_->addresses().at(0);
        port_ = std::stoi(url.substr(url.rfind(':') + 1));
    }
    [[nodiscard]] std::string get(std::string_view target, std::string_view headers = "") const {
        return RawClient::get(port_, target, headers);
    }

    ServerOptions options_;
    std::shared_ptr<Doors> doors_ = std::make_shared<Doors>();
    std::unique_ptr<Server> server_;
    int port_ = 0;
};

}  // namespace stormcellar::web
