# Install, packages.
