"""Problems, poses, reports and documents; the models behind the user interface."""
