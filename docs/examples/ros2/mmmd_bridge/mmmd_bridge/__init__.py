"""A bridge from ROS 2 to mmmd."""
