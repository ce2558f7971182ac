#include "server/command/commands.h"
#include "server/http/health_client.h"

#include <cstdio>

namespace toile {

int run_health(const HealthArguments& arguments) {
  bool well = false;
  const std::string body = ask_health(arguments.host, arguments.port, well);
  std::fputs(body.empty() ? "no answer\n" : body.c_str(), well ? stdout : stderr);
  return well ? 0 : 1;
}

}  // namespace toile
