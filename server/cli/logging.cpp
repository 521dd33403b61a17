#include "logging.h"

#include <cstdio>

#include <boost/json/object.hpp>
#include <boost/json/serialize.hpp>
#include <spdlog/details/log_msg.h>
#include <spdlog/pattern_formatter.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <spindrift/core/text.h>

namespace spindrift::cli {
namespace {

/// The text of a message. Names and reasons in it may come from outside: none begins a line that looks like another
/// message, or changes the terminal.
class MessageText final : public spdlog::custom_flag_formatter {
 public:
  void format(const spdlog::details::log_msg& message, const std::tm&, spdlog::memory_buf_t& out) override {
    const std::string text = indentLines({message.payload.data(), message.payload.size()});
    out.append(text.data(), text.data() + text.size());
  }
  [[nodiscard]] std::unique_ptr<custom_flag_formatter> clone() const override {
    return std::make_unique<MessageText>();
  }
};

/// A failure can occur anywhere in main(), so its form and the name cannot be passed down like an option.
bool writes_json = false;
std::string program_name = "spindrift";

}  // namespace

void JsonLogFormatter::format(const spdlog::details::log_msg& message, spdlog::memory_buf_t& line) {
  const auto level = spdlog::level::to_string_view(message.level);
  const boost::json::object object{
      {"time", core::rfc3339(message.time)},
      {"level", std::string_view(level.data(), level.size())},
      {"thread", message.thread_id},
      {"message", core::toValidUtf8({message.payload.data(), message.payload.size()})},
  };
  const std::string text = boost::json::serialize(object) + "\n";  // escapes quotes and control characters
  line.append(text.data(), text.data() + text.size());
}

std::unique_ptr<spdlog::formatter> JsonLogFormatter::clone() const {
  return std::make_unique<JsonLogFormatter>();
}

std::string indentLines(std::string_view text) {
  std::string out;
  while (true) {
    const std::size_t end = text.find('\n');
    out += core::cleanText(text.substr(0, end), text.size());
    if (end == std::string_view::npos || end + 1 == text.size()) return out;
    out += "\n    ";
    text.remove_prefix(end + 1);
  }
}

void addLogOptions(CLI::App& program, LogOptions& options) {
  program.add_option("--log-level", options.level, "Level of the log on standard error")
      ->check(CLI::IsMember({"trace", "debug", "info", "warning", "error", "off"}))
      ->capture_default_str();
  program.add_option("--log-format", options.format, "Form of the log: text, or json (one object per line)")
      ->check(CLI::IsMember({"text", "json"}))
      ->capture_default_str();
}

void nameProgram(const std::string& name) {
  program_name = name;
}

void setUpLogging(const LogOptions& options) {
  writes_json = options.format == "json";
  auto logger = spdlog::stderr_color_mt(program_name);
  if (writes_json) {
    logger->set_formatter(std::make_unique<JsonLogFormatter>());
  } else {
    auto formatter = std::make_unique<spdlog::pattern_formatter>();
    formatter->add_flag<MessageText>('*').set_pattern("%H:%M:%S.%e %^%l%$ %*");
    logger->set_formatter(std::move(formatter));
  }
  logger->set_level(spdlog::level::from_str(options.level));
  spdlog::set_default_logger(std::move(logger));
}

void reportFailure(const std::string& message) {
  if (!writes_json) {
    std::fprintf(stderr, "%s: %s\n", program_name.c_str(), message.c_str());
    return;
  }
  // Not through the logger: --log-level off must not hide why the program ended.
  spdlog::memory_buf_t line;
  JsonLogFormatter().format(spdlog::details::log_msg(program_name, spdlog::level::err, message), line);
  std::fwrite(line.data(), 1, line.size(), stderr);
}

}  // namespace spindrift::cli
