#include "forms.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <string>
#include <string_view>

#include <unistd.h>

#include <spindrift/core/text.h>
#include <spindrift/http/network_text.h>
#include <spindrift/net/client.h>

namespace spindrift::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kBlank = " \t\r\n";

void trim(std::string& text) {
  text.erase(0, std::min(text.find_first_not_of(kBlank), text.size()));
  text.erase(text.find_last_not_of(kBlank) + 1);
}

std::string bounds(double min, double max) {
  return core::formatNumber(min) + " to " + core::formatNumber(max);
}

/// The form in which CLI11 shows a range, and in which config_file.cpp finds it.
std::string rangeText(const char* type, double min, double max) {
  return std::string(type) + " in [" + core::formatNumber(min) + " - " + core::formatNumber(max) + "]";
}

/// Makes a validator of a check that returns core::Result<void>.
template <typename Check>
CLI::Validator checkedBy(Check check, bool trims) {
  return {[check, trims](std::string& text) {
            if (trims) trim(text);
            const core::Result<void> checked = check(text);
            return checked ? std::string() : checked.error().message;
          },
          ""};
}

/// Returns what is wrong with one server, without the server's text: it may hold a password.
std::string faultOfNatsServer(std::string_view server) {
  if (server.find_first_of(kBlank) != std::string_view::npos) return "has a blank in it";
  if (const std::size_t mark = server.find("://"); mark != std::string_view::npos) {
    const std::string_view scheme = server.substr(0, mark);
    if (scheme != "nats" && scheme != "tls") return "begins with " + std::string(scheme) + "://";
    server.remove_prefix(mark + 3);
  }
  server.remove_prefix(std::min(server.rfind('@') + 1, server.size()));  // npos + 1 is 0
  if (server.ends_with('/')) server.remove_suffix(1);
  if (server.find_first_of("/?#") != std::string_view::npos) return "has a path behind its port";
  const auto url = net::ClientUrl::parse("ws://" + std::string(server));
  return url ? "" : "has no host, or a port that is not a number from 0 to 65535";
}

}  // namespace

CLI::Validator numberIn(double min, double max) {
  return {[=](std::string& text) -> std::string {
            double value = 0;
            if (!CLI::detail::lexical_cast(text, value) || !std::isfinite(value))
              return "Value " + text + " is not a number from " + bounds(min, max);
            return value >= min && value <= max ? "" : "Value " + text + " not in range " + bounds(min, max);
          },
          rangeText("FLOAT", min, max)};
}

CLI::Validator integerIn(std::int64_t min, std::int64_t max) {
  const auto first = static_cast<double>(min);
  const auto last = static_cast<double>(max);
  return {[=](std::string& text) -> std::string {
            std::int64_t value = 0;
            if (!CLI::detail::lexical_cast(text, value))
              return "Value " + text + " is not a whole number from " + bounds(first, last);
            return value >= min && value <= max ? "" : "Value " + text + " not in range " + bounds(first, last);
          },
          rangeText("INT", first, last)};
}

CLI::Validator isNotEmpty() {
  return {[](std::string& text) {
            return text.empty() ? std::string("Value is empty; leave the option out instead") : std::string();
          },
          ""};
}

CLI::Validator isText() {
  return {[](std::string& text) -> std::string {
            if (text.empty()) return "Value is empty; leave the option out instead";
            std::string trimmed = text;
            trim(trimmed);
            const bool has_control = std::ranges::any_of(text, [](unsigned char c) { return std::iscntrl(c) != 0; });
            if (trimmed == text && !has_control) return "";
            constexpr std::size_t kEchoMaxBytes = 200;
            return "Value '" + core::quoteText(text, kEchoMaxBytes) +
                   "' has blanks at its ends or control characters; remove them";
          },
          ""};
}

CLI::Validator isListenAddress() {
  return checkedBy(net::checkListenAddress, false);
}

CLI::Validator isNetwork() {
  return checkedBy(net::checkNetwork, true);
}

CLI::Validator isOrigin() {
  return checkedBy(net::checkOrigin, true);
}

CLI::Validator isParentOrigin() {
  return checkedBy(net::checkParentOrigin, true);
}

CLI::Validator isUrl() {
  return {[](std::string& text) {
            const auto url = net::ClientUrl::parse(text);
            return url ? std::string() : "Value " + text + " is not a URL: write ws://HOST:PORT or wss://HOST:PORT";
          },
          ""};
}

CLI::Validator isServer() {
  return {[](std::string& text) {
            const auto url = net::ClientUrl::parse(text);
            return url && url->path == "/"
                       ? std::string()
                       : "Value " + text + " is not a server: write ws://HOST:PORT or wss://HOST:PORT";
          },
          ""};
}

CLI::Validator isPageUrl() {
  return {[](std::string& text) {
            const bool is_http = text.starts_with("http") && text.find_first_of("?#") == std::string::npos;
            const bool is_url = is_http && net::ClientUrl::parse("ws" + text.substr(4));
            return is_url ? std::string()
                          : "Value " + text + " is not the address of a page: write https://HOST or https://HOST/PATH";
          },
          ""};
}

CLI::Validator isNatsServers() {
  return {[](std::string& text) -> std::string {
            std::size_t number = 0;
            for (const std::string& server : CLI::detail::split(text, ',')) {
              ++number;
              const std::string fault = server.empty() ? "is empty" : faultOfNatsServer(server);
              if (fault.empty()) continue;
              return "server " + std::to_string(number) + " of the list " + fault +
                     ": write nats://[USER:PASSWORD@]HOST:PORT or tls://…, several with ',' and no blanks between them";
            }
            return number > 0 ? "" : "Value is empty; leave the option out instead";
          },
          ""};
}

CLI::Validator isRoom() {
  return {[](std::string& text) {
            const std::size_t equals = text.find('=');
            const bool has_both = equals != std::string::npos && equals > 0 && equals + 1 < text.size();
            return has_both ? std::string() : "Value " + text + " is not a room: write NAME=SCENE";
          },
          ""};
}

CLI::Validator isOutputFile() {
  return {[](std::string& text) -> std::string {
            if (text == "-") return "";
            std::error_code ignored;
            const fs::path folder = fs::path(text).has_parent_path() ? fs::path(text).parent_path() : fs::path(".");
            const std::string shown = "Value '" + text + "' cannot be written: ";
            if (text.empty() || fs::is_directory(text, ignored)) return shown + "it is not a file; name a file";
            if (!fs::is_directory(folder, ignored))
              return shown + "there is no folder " + folder.string() + "; make it";
            if (::access(fs::exists(text, ignored) ? text.c_str() : folder.c_str(), W_OK) != 0)
              return shown + "this user may not write there; choose another folder";
            return "";
          },
          ""};
}

}  // namespace spindrift::cli
