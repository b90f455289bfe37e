#pragma once

// Writes a manifest as a whole, as tests want to have it.

#include <algorithm>

#include "recording/store/format/format_version.h"
#include "recording/store/format/layout.h"
#include "recording/store/manifest/manifest.h"

namespace imunoise::recording {

/// Into manifest.json and a file a replicate.
inline Result<void> write_manifest(FileSystem& files, const std::filesystem::path& root,
                                   const v1::Manifest& whole) {
  RecordingManifestFile split = split_manifest(whole);
  for (auto& [replicate, manifest] : *split.replicates) {
    if (auto done = write_replicate_manifest(files, root, replicate, manifest); !done) return done;
  }
  return write_recording_manifest(files, root, split.recording);
}

/// Into one file, as version 1 of the format had it.
inline Result<void> write_manifest_of_version_1(FileSystem& files,
                                                const std::filesystem::path& root,
                                                v1::Manifest whole) {
  whole.set_version(1);
  return replace_file(files, root / kManifestName, print_manifest(whole));
}

/// Replaces the note of its replicate, or adds it, in order.
inline void set_note(v1::Manifest& manifest, const v1::ReplicateNote& note) {
  auto& notes = *manifest.mutable_replicates();
  const auto same = std::find_if(notes.begin(), notes.end(), [&](const v1::ReplicateNote& one) {
    return one.replicate() == note.replicate();
  });
  if (same != notes.end()) {
    *same = note;
  } else {
    *notes.Add() = note;
  }
}

}  // namespace imunoise::recording
