#!/usr/bin/env bash
# Builds the Debian package, and says what is in it and what lintian thinks of it.
#
#   bash scripts/package.sh [REVISION]     Debian's revision; 1 unless given
#
# The package is left in build/package/package/.
set -euo pipefail
# shellcheck source=scripts/common.sh
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

revision=${1:-1}
out=build/package/package

bash scripts/install_packages.sh package
echo "Building the package ..."
configure package -D IMUNOISE_PACKAGE_REVISION="$revision"
compile package
quietly build/log/package-cpack.txt cpack --config build/package/CPackConfig.cmake
package=$(find "$out" -maxdepth 1 -name "*.deb" -newer build/log/package-build.txt)

echo
dpkg-deb --info "$package"
echo "lintian:"
lintian --allow-root --fail-on error,warning "$package"
echo "no errors, no warnings"
echo
echo "The package: $package"
