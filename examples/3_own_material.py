# %% [markdown]
# # 3. Your own material
#
# A material system is one text file: the section of the beams, how the plastic deforms in the hot
# bath, how much it shrinks, what it weighs. Here you make your own by changing the one that comes
# along, and see what that does. `docs/learning.md` tells how a learned model is trained for it.

# %%
# ruff: noqa: D100
import os
from pathlib import Path

from simulearn import Grid, InputError, make, outputs, simulate, validate
from simulearn.material import read_material
from simulearn.material.reading import HERE

SMALL = bool(os.environ.get("SIMULEARN_SMALL"))
OUT = Path("out/3_own_material")
OUT.mkdir(parents=True, exist_ok=True)

# %% [markdown]
# ## The file
# Every line of the file has its unit beside it. We write beams of 3.2 mm instead of 4 mm, printed
# so that the active half shrinks by 8 % (a strip then bends more, as it is thinner).

# %%
text = (HERE / "pla-hot-water.toml").read_text("utf-8")
for old, new in {
    'name = "pla-hot-water"': 'name = "my-pla"',
    'title = "PLA in water of 80 C"': 'title = "My PLA, thinner"',
    "thickness = 4.0 ": "thickness = 3.2 ",
    "active = 0.09261 ": "active = 0.080 ",
    "shell = 0.09261 ": "shell = 0.080 ",
}.items():
    assert old in text, old
    text = text.replace(old, new)
file = OUT / "my-pla.toml"
file.write_text(text, "utf-8")
material = read_material(file)
print(material.title, "-", material.identity)
print("beams of", material.section.width, "by", material.section.thickness, "mm")

# %% [markdown]
# A wrong number is found when the file is read, and the message names the key.

# %%
wrong = OUT / "wrong.toml"
wrong.write_text(text.replace("thickness = 3.2 ", "thickness = -3.2 "), "utf-8")
try:
    read_material(wrong)
except InputError as error:
    print(error)

# %% [markdown]
# ## The same grid of both
# A grid names its material: one that comes along, or the path of your file. Finite elements take
# any material.

# %%
plain = make("saddle", (1, 1) if SMALL else (2, 2), 60.0)
mine = Grid(plain.joints, plain.beams, plain.actuators, plain.fixed, file)
print("valid" if validate(mine).valid else validate(mine).errors[0].message)
results = {
    "PLA": simulate(plain, engine="fea"),
    "my PLA": simulate(mine, engine="fea"),
}
for name, result in results.items():
    z = result.centres[-1][:, 2]
    print(f"{name}: joints from {z.min():.1f} to {z.max():.1f} mm")
results["my PLA"]

# %% [markdown]
# The learned model knows a family of materials, so it answers for this one, too, in milliseconds.
# What is far outside that family, as a plastic that shrinks by a third, it refuses; it does not
# guess.

# %%
learned = simulate(mine, engine="learned")
print(f"learned: nine of ten such answers are off by less than {learned.bound_mm:.2f} mm")
far = OUT / "far.toml"
far.write_text(text.replace("active = 0.080 ", "active = 0.33 "), "utf-8")
try:
    simulate(Grid(plain.joints, plain.beams, plain.actuators, plain.fixed, far), engine="learned")
except InputError as error:
    print(error)

# %%
for name, result in results.items():
    outputs.write(result, OUT / f"{name.replace(' ', '-')}.png")
print("wrote", ", ".join(sorted(path.name for path in OUT.iterdir())))
