#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include <nlohmann/json.hpp>

namespace bole {

/// Writes a camera.toml for one of the folders with frames and truth, its mount from truth.json,
/// into `folder`; answers its path. `mask`: in place of the folder's own; "none" leaves it out.
inline std::filesystem::path write_shared_camera(const std::filesystem::path& data,
                                                 const std::filesystem::path& folder,
                                                 const std::string& search,
                                                 const std::string& mask = "") {
  const nlohmann::json truth = nlohmann::json::parse(std::ifstream(data / "truth.json"));
  const nlohmann::json& sides = truth.at("mount");
  const nlohmann::json& angles = truth.contains("height_m") ? truth : sides;
  std::filesystem::create_directories(folder);
  std::ofstream toml(folder / "camera.toml");
  toml << "[camera]\nmodel = \"ocam\"\ncalibration = " << data / "calib_results.txt"
       << "\n";
  if (mask != "none")
    toml << "mask = " << (mask.empty() ? data / "mask.png" : std::filesystem::path(mask)) << "\n";
  toml << "[mount]\n";
  for (const char* key : {"forward", "left"}) toml << key << " = " << sides.at(key) << "\n";
  for (const char* key : {"height_m", "roll_deg", "pitch_deg", "yaw_deg"}) {
    toml << key << " = " << angles.at(key) << "\n";
  }
  toml << "[search]\n" << search << "\n";
  return folder / "camera.toml";
}

}  // namespace bole
