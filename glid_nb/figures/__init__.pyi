from .overview_figure import figure_png as figure_png
from .overview_figure import overview as overview
