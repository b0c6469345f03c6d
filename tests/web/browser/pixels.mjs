// The pixels of a light's map on the result page, and their visibility functions.
import assert from 'node:assert/strict';

const legendAt = (page, words) => page.waitForFunction((w) => document.querySelector('#curves .curve-title').textContent.includes(w), words);

export async function choosePixel(page, x, y) {
  await page.fill('#curves input[aria-label="x"]', String(x));
  await page.fill('#curves input[aria-label="y"]', String(y));
  await page.click('#curves button:has-text("Show")');
  await legendAt(page, `${x}, ${y}`);
}

// The share of the light that the chosen pixel is said to let through.
export async function spoken(page) {
  return Number(/: ([\d.]+) % of the light/.exec(await page.locator('#status').innerText())[1]) / 100;
}

// The same of the picture.
function pictureAt(page, x, y) {
  return page.locator('#curves .grid img').evaluate((image, [px, py]) => {
    const canvas = document.createElement('canvas');
    canvas.width = image.naturalWidth;
    canvas.height = image.naturalHeight;
    const paint = canvas.getContext('2d');
    paint.drawImage(image, 0, 0);
    const v = paint.getImageData(px, image.naturalHeight - 1 - py, 1, 1).data[0] / 255;
    return v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4;
  }, [x, y]);
}

export async function curves(page, mock) {
  await page.waitForSelector('#curves .curve-legend');
  await choosePixel(page, 7, 9);
  const rows = await page.locator('#curves .curve-legend tbody tr').count();
  assert.ok(rows >= 4, `${rows} functions`);
  const plot = '#curves [aria-label^="Visibility against"] .mark-line path', lines = page.locator(plot);
  const drawn = await lines.count();
  assert.ok(drawn >= 3, `${drawn} lines`);
  await page.locator('#curves .curve-legend input').first().uncheck();
  await page.waitForFunction(([all, n]) => document.querySelectorAll(all).length === n, [plot, drawn - 1]);

  // Pixels are chosen over a picture of the map, with the pointer and from the keyboard, and are spoken.
  const grid = page.locator('#curves .grid');
  await grid.scrollIntoViewIfNeeded();
  await page.waitForFunction(() => document.querySelector('#curves .grid img').naturalWidth === 32);
  const box = await grid.boundingBox();
  await page.mouse.move(box.x + box.width * 0.51, box.y + box.height * 0.26);
  await legendAt(page, '16, 23');
  await grid.focus();
  await page.keyboard.press('ArrowRight');
  await legendAt(page, '17, 23');
  await page.keyboard.press('ArrowUp');
  await legendAt(page, '17, 24');
  await page.keyboard.press('Shift+ArrowDown');
  await legendAt(page, '17, 16');
  assert.match(await grid.getAttribute('aria-label'), /Map of light key, 32 by 32 pixels, at 17, 16\./);
  const marker = await page.locator('#curves .marker').boundingBox();
  assert.ok(Math.abs(marker.x + marker.width / 2 - box.x - box.width * 17.5 / 32) < 2, 'the marker is in its column');
  assert.ok(Math.abs(marker.y + marker.height / 2 - box.y - box.height * 15.5 / 32) < 2, 'the marker is in its row');
  if (mock) return;
  for (const [x, y] of [[17, 16], [2, 29], [14, 20], [29, 13]]) {
    await choosePixel(page, x, y);
    const [said, shown] = [await spoken(page), await pictureAt(page, x, y)];
    assert.ok(Math.abs(said - shown) < 0.01, `${said} gets through ${x}, ${y}, and ${shown} in the picture`);
  }
}
