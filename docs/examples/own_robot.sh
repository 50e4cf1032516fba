#!/bin/sh
# Your own robot from its URDF, the steps of docs/robots.md in one go: `sh docs/examples/own_robot.sh [FILE.urdf [FOLDER]]`.
# It needs no daemon and no servos; the last step plays texts on simulated servos and checks every goal against the limits.
set -e
urdf=${1:-docs/examples/own_robot.urdf}
folder=${2:-own_robot}

# 1. Forward kinematics finds arms, neck and waist; FOLDER/robot.toml holds "?" wherever only you know the answer.
mkdir -p "$folder"
cp "$urdf" "$folder/robot.urdf"
mmmd robot new "$folder/robot.urdf" --servo XL430-W250

# 2. The servos' ids: 1, 2, 3 and so on here, in the order of the file. Yours are those that `mmmd scan` finds.
awk '{ if (sub(/id = "\?"/, "id = " (n + 1))) n++; print }' "$folder/robot.toml" >"$folder/filled.toml"
mv "$folder/filled.toml" "$folder/robot.toml"

# 3. What is missing, what could touch, and pictures: at rest, arms out, in a gesture.
mmmd robot check "$folder"
mmmd robot show "$folder" --out "$folder/robot.png"

# 4. Two texts in virtual time, also under faults: each goal inside its limits, and the robot off its own body.
mmmd bench audit --robot "$folder" --n 2

echo "next: mmmd run --robot $folder --bus sim:// --view"
