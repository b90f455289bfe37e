#include "daemon/config/campaign_keys.h"

namespace imunoise::config {

const std::vector<CampaignKey>& campaign_keys() {
  static const std::vector<CampaignKey> kKeys = {
      {"", "name", "TEXT", "Name of the campaign: letters, digits, '_', '-' and '.'", ""},
      {"", "folder", "FOLDER",
       "Folder of the recordings; each has a folder of its own, named by its start in UTC", ""},
      {"", "length", "TIME", "Length of each replicate, at least 1 s", ""},
      {"", "replicates", "COUNT", "Number of replicates per recording", "1"},
      {"", "settling", "TIME", "Time at rest before the first replicate", "0 s"},
      {"", "pause", "TIME", "Time between replicates", "0 s"},
      {"", "patience", "TIME", "Time to wait for a device before a replicate begins without it",
       "1 min"},
      {"", "reserve", "SIZE", "Disk space to keep free", "1 GB"},
      {"", "wire", "true|false", "Keep the raw bytes of each device, too", "false"},
      {"schedule", "every", "TIME", "Time from the start of one recording to the start of the next",
       "one recording, now"},
      {"schedule", "calendar", "TEXT",
       "systemd calendar expression; a systemd timer then starts imunoised --once", "none"},
      {"calibration", "enabled", "true|false", "Calibrate each complete recording", "true"},
      {"calibration", "models", "LIST",
       "Models to fit to each channel; of several, cross-validation chooses the best",
       "the best of many"},
      {"calibration", "diagnose", "true|false", "Search for missing effects", "true"},
      {"calibration", "array", "true|false",
       "Analyse the channels of one quantity as an array, and compare devices", "false"},
      {"calibration", "array_model", "TEXT", "Model of the array", "AR1 + WN + RW[corr]"},
      {"retention", "recordings", "COUNT",
       "Greatest number of recordings to keep; the oldest are deleted", "all"},
      {"retention", "age", "TIME",
       "Greatest age of recordings to keep; the newest recording is always kept", "all"},
      {"stillness", "repeat_disturbed", "true|false",
       "Record a replicate again if the sensors moved during it", "false"},
      {"stillness", "repeats", "COUNT", "Greatest number of repetitions of one replicate", "1"},
      {"device", "name", "TEXT", "Name of the device in the recording", "name of the driver"},
      {"device", "driver", "TEXT", "Driver of the device; imunoise drivers lists them", ""},
      {"device", "options", "TABLE", "Options of the driver; imunoise drivers lists them", "none"}};
  return kKeys;
}

}  // namespace imunoise::config
