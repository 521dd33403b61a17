#include <algorithm>
#include <memory>
#include <string>

#include <boost/json.hpp>
#include <fmt/format.h>

#include <spindrift/core/version.h>
#include <spindrift/gpu/device.h>
#include <spindrift/scene/parameters.h>
#include <spindrift/wire/client_message.h>

#include "commands.h"

namespace spindrift::cli {
namespace {

struct InfoOptions {
  std::string json_file;  ///< "-" = standard output
  bool parameters = false;
};

boost::json::object toJson(const gpu::DeviceInfo& d) {
  const gpu::DeviceLimits& l = d.limits;
  return {{"index", d.index},
          {"name", d.name},
          {"vendor", d.vendor},
          {"gl_version", d.gl_version},
          {"glsl_version", d.glsl_version},
          {"egl_driver", d.egl_driver},
          {"drm_file", d.drm_file},
          {"render_file", d.render_file},
          {"uuid", d.uuid},
          {"is_software", d.is_software},
          {"problem", d.problem},
          {"limits", boost::json::object{{"max_ssbo_bytes", l.max_ssbo_bytes},
                                         {"max_texel_buffer_elements", l.max_texel_buffer_elements},
                                         {"max_uniform_block_bytes", l.max_uniform_block_bytes},
                                         {"max_work_group_invocations", l.max_work_group_invocations},
                                         {"max_work_group_count_x", l.max_work_group_count_x},
                                         {"max_shared_memory_bytes", l.max_shared_memory_bytes},
                                         {"max_ssbo_bindings", l.max_ssbo_bindings}}}};
}

int info(const InfoOptions& options) {
  if (options.parameters) {
    fmt::print("{}", scene::parameterReferenceMarkdown());
    return 0;
  }
  const gpu::GpuInfo gpu = gpu::collectInfo({});
  boost::json::array devices;
  for (const gpu::DeviceInfo& d : gpu.devices) devices.push_back(toJson(d));
  const boost::json::object json = {
      {"program", core::nameAndVersion()},
      {"wire", fmt::format("{}.{}", wire::kWireMajor, wire::kWireMinor)},
      {"egl_client_version", gpu.egl_client_version},
      {"shader_count", gpu.shader_count},
      {"devices", devices},
      {"chosen", gpu.chosen ? boost::json::value(toJson(*gpu.chosen)) : boost::json::value()},
      {"why", gpu.why}};
  if (options.json_file != "-") {
    fmt::print("program   {}, wire {}.{}, {} shaders\nEGL       {}\n", core::nameAndVersion(), wire::kWireMajor,
               wire::kWireMinor, gpu.shader_count, gpu.egl_client_version);
    for (const gpu::DeviceInfo& d : gpu.devices) {
      fmt::print("device {:>2} {}\n", d.is_software ? "sw" : std::to_string(d.index), d.name);
      const auto names = {d.drm_file, d.render_file, d.uuid};
      if (std::ranges::any_of(names, [](const std::string& name) { return !name.empty(); }))
        fmt::print("          {}\n", fmt::join(names, " "));
      if (!d.problem.empty()) {
        fmt::print("          cannot be used: {}\n", d.problem);
        continue;
      }
      fmt::print("          {}, OpenGL {}, EGL {}\n", d.vendor, d.gl_version, d.egl_driver);
      fmt::print(
          "          storage block {} MB, buffer texture {} M texels, group {} invocations, shared memory {} KB\n",
          d.limits.max_ssbo_bytes >> 20, d.limits.max_texel_buffer_elements >> 20, d.limits.max_work_group_invocations,
          d.limits.max_shared_memory_bytes >> 10);
    }
    fmt::print("auto      {}\n", gpu.why);
    if (gpu.chosen && !gpu.chosen->advice.empty()) fmt::print("          {}\n", gpu.chosen->advice);
  }
  if (auto written = writeJson(options.json_file, json); !written) return fail(written.error());
  return gpu.chosen ? 0 : core::exitCode(core::ErrorCode::kNoDevice);
}

}  // namespace

ProgramCommand addInfo(CLI::App& program) {
  const auto options = std::make_shared<InfoOptions>();
  CLI::App* command =
      program.add_subcommand("info", "Devices, OpenGL and driver versions, limits, versions of program and wire");
  addJson(*command, options->json_file);
  command->add_flag("--parameters", options->parameters,
                    "Print the reference of all scene parameters instead, as Markdown");
  return {command, [options] { return info(*options); }};
}

}  // namespace spindrift::cli
