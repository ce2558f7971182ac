#include "server/http/health_client.h"

#include <httplib.h>

namespace toile {

std::string ask_health(const std::string& host, int port, bool& well) {
  constexpr int kPatienceS = 5;
  httplib::Client client(host, port);
  client.set_connection_timeout(kPatienceS);
  client.set_read_timeout(kPatienceS);
  const httplib::Result result = client.Get("/healthz");
  well = result && result->status == 200;
  return result ? result->body : std::string();
}

}  // namespace toile
