#pragma once
// A whole service inside the test's process: a real store and dispatcher, a fake run, HTTP on a free loopback port.

#include "server/http/http_server.h"
#include "server/http/service.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace toile {

struct Answer {
  int status = 0;    ///< 0: the connection gave no answer
  std::string head;  ///< the header fields as they came
  std::string body;
  nlohmann::json json() const { return nlohmann::json::parse(body, nullptr, false); }
  /// The value of a header field; empty when it is not there.
  std::string header(const std::string& name) const;
};

class ServiceFixture : public testing::Test {
 protected:
  void SetUp() override;
  void TearDown() override;

  /// Sends these bytes on a connection of their own and reads until the server closes it or is silent for a while.
  Answer raw(const std::string& bytes) const;
  Answer request(const std::string& method, const std::string& path, const std::string& body = {},
                 const std::vector<std::pair<std::string, std::string>>& headers = {}) const;
  /// Sends a scene whose fake run does `what` (tests/server/queue/fake_run.sh).
  Answer submit(const std::string& what) const;
  /// The job's document once it is final, or after ten seconds as it is then.
  nlohmann::json wait_for_end(const std::string& id) const;

  DispatcherOptions options_;
  const TemporaryFolder folder_;
  std::unique_ptr<Store> store_;
  std::unique_ptr<Dispatcher> dispatcher_;
  std::unique_ptr<PreviewRenderer> previews_;
  std::unique_ptr<Service> service_;
  std::unique_ptr<HttpServer> server_;
  std::thread thread_;
  int port_ = 0;
};

/// A valid scene, as text, whose garment has this name.
std::string scene_named(const std::string& name);

}  // namespace toile
