(** * Return maps: two clocks as a product over an exchange of two intervals

    From slow kick to slow kick the slow clock's offset behind the last fast kick moves by an exchange of two intervals:
    [0, a) moves right by b, [a, a + b) moves left by a. Each kick multiplies by a matrix that depends on the offset alone.
    A level holds the widths a, b of the two intervals that are left, the numbers of kicks after which each returns
    (its height), and the products over those kicks as functions of the offset (its branches).

    - [pulled_back]     the matrix of a slow kick at the offset x, as seen from the fast kick before it;
    - [first_returns]    the exchange itself is a level;
    - [euclid_returns]   one step of Euclid's algorithm on the widths makes a level of a level, by one product;
    - [areas]            heights times widths sum to the whole length, at every level;
    - [last_period]      where the left interval has shrunk to nothing, the right branch at 0 is the period;
    - [walk_product]     any walk over levels that uses up n kicks multiplies to the product of the next n kicks;
    - [band_growth]      determinant-one matrices that map one cone into its interior by a margin multiply to exponential growth,
                         in whatever order they come: so every offset, and every ratio of the steps, rational or not;
    - [band_unstable]    a period of such returns is hyperbolic;
    - [turning_along]    in a frame that turns with the offset the products are the same, turned at both ends. *)

From Kickdrift Require Import Vocabulary Algebra Stability Plane Cone.
From Coq Require Import Reals Lra Lia Psatz.
Open Scope R_scope.

Lemma pulled_back k x : drift (- x) ** kick k ** drift x = Mat (1 + k * x) (k * (x * x)) (- k) (1 - k * x).
Proof. matrix_ring. Qed.

Section Exchange.

(** The lengths of the two intervals, and the matrix of the kick that is met at an offset. *)
Variables (a0 b0 : R) (kicked : R -> mat).

Definition turn (x : R) := if Rlt_dec x a0 then x + b0 else x - a0.

Fixpoint turns (n : nat) (x : R) := match n with O => x | S n' => turns n' (turn x) end.

(** The product over the next n kicks from the offset x on; the first kick acts first. *)
Fixpoint along (n : nat) (x : R) : mat := match n with O => one | S n' => along n' (turn x) ** kicked x end.

Lemma turns_add m n x : turns (m + n) x = turns n (turns m x).
Proof. revert x; induction m; simpl; auto. Qed.

Lemma along_add m n x : along (m + n) x = along n (turns m x) ** along m x.
Proof.
  revert x; induction m as [|m IH]; intros x; simpl; [now rewrite mul_one_r|].
  now rewrite IH, mul_assoc.
Qed.

Record level := Level {
  left_width : R; right_width : R;
  left_height : nat; right_height : nat;
  left_branch : R -> mat; right_branch : R -> mat
}.

Definition on_left l x := 0 <= x < left_width l.
Definition on_right l x := left_width l <= x < left_width l + right_width l.

Definition returns (l : level) :=
  (forall x, on_left l x ->
     turns (left_height l) x = x + right_width l /\ left_branch l x = along (left_height l) x) /\
  (forall x, on_right l x ->
     turns (right_height l) x = x - left_width l /\ right_branch l x = along (right_height l) x).

Definition first := Level a0 b0 1 1 kicked kicked.

(** The branches in this order: what is met second stands in front. *)
Definition euclid (l : level) :=
  let (a, b, m, n, A, B) := l in
  if Rle_dec b a then Level (a - b) b m (m + n) A (fun x => B (x + b) ** A x)
  else Level a (b - a) (m + n) n (fun x => B (x + b) ** A x) B.

Theorem first_returns : returns first.
Proof.
  split; intros x [L U]; simpl in *; unfold turn; destruct Rlt_dec; try lra; rewrite mul_one_l; auto.
Qed.

Theorem euclid_returns l : 0 <= left_width l -> 0 <= right_width l -> returns l -> returns (euclid l).
Proof.
  destruct l as [a b m n A B]; unfold returns, on_left, on_right, euclid; simpl; intros a_pos b_pos [L R].
  destruct Rle_dec as [long|short]; simpl; split; intros x X.
  - apply L; lra.
  - destruct (L x) as [T P]; [lra|]; destruct (R (x + b)) as [T' P']; [lra|].
    rewrite turns_add, along_add, T, T', P', P; split; [lra | reflexivity].
  - destruct (L x) as [T P]; [lra|]; destruct (R (x + b)) as [T' P']; [lra|].
    rewrite turns_add, along_add, T, T', P', P; split; [lra | reflexivity].
  - apply R; lra.
Qed.

Definition area (l : level) := INR (left_height l) * left_width l + INR (right_height l) * right_width l.

Theorem areas l : area (euclid l) = area l.
Proof.
  destruct l as [a b m n A B]; unfold area, euclid; simpl; destruct Rle_dec; simpl; rewrite plus_INR; ring.
Qed.

(** All levels: k steps of Euclid's algorithm. *)
Fixpoint deep (k : nat) := match k with O => first | S k' => euclid (deep k') end.

Theorem deep_level k :
  0 <= a0 -> 0 <= b0 ->
  0 <= left_width (deep k) /\ 0 <= right_width (deep k) /\ returns (deep k) /\ area (deep k) = a0 + b0.
Proof.
  intros A0 B0; induction k as [|k (A & B & R & S)]; simpl.
  - split; [exact A0|]; split; [exact B0|]; split; [apply first_returns | unfold area; simpl; ring].
  - split; [|split; [|split; [now apply euclid_returns | now rewrite areas]]];
      destruct (deep k); simpl in *; destruct Rle_dec; simpl; lra.
Qed.

Theorem last_period k :
  0 <= a0 -> 0 <= b0 -> 0 < a0 + b0 -> left_width (deep k) = 0 ->
  let n := right_height (deep k) in
  INR n * right_width (deep k) = a0 + b0 /\ turns n 0 = 0 /\ right_branch (deep k) 0 = along n 0.
Proof.
  intros A0 B0 P Z n; destruct (deep_level k A0 B0) as (_ & B & (_ & R) & S); fold n in R.
  assert (E : INR n * right_width (deep k) = a0 + b0) by (unfold area in S; rewrite Z in S; unfold n; lra).
  destruct (R 0) as [T Q]; [unfold on_right; rewrite Z; split; [lra|] |].
  - destruct (Req_dec (right_width (deep k)) 0) as [F|]; [rewrite F in E|]; lra.
  - rewrite T, Z; repeat split; [exact E | lra | exact Q].
Qed.

(** A walk of n kicks from x: at each return any level may be used that the offset lies in and whose height still fits. *)
Inductive walk : nat -> R -> mat -> Prop :=
  | arrived x : walk 0 x one
  | by_left l n x P : returns l -> on_left l x -> walk n (x + right_width l) P ->
      walk (left_height l + n) x (P ** left_branch l x)
  | by_right l n x P : returns l -> on_right l x -> walk n (x - left_width l) P ->
      walk (right_height l + n) x (P ** right_branch l x).

Theorem walk_product n x P : walk n x P -> P = along n x.
Proof.
  induction 1 as [x | l n x P [L _] X _ IH | l n x P [_ R] X _ IH]; [reflexivity | |].
  - destruct (L x X) as [T E]; now rewrite along_add, T, E, IH.
  - destruct (R x X) as [T E]; now rewrite along_add, T, E, IH.
Qed.

(** A return leaves the offset inside its level, so that a walk can go on with the same one or a shallower one. *)
Theorem walk_stays l x :
  0 <= left_width l -> 0 <= right_width l ->
  (on_left l x -> 0 <= x + right_width l < left_width l + right_width l) /\
  (on_right l x -> 0 <= x - left_width l < left_width l + right_width l).
Proof. unfold on_left, on_right; split; intros; lra. Qed.

End Exchange.

(** ** Bands: a common cone *)

(** [inside_by d u w M]: M u = a u + c w and M w = b u + e w with all four positive and b c >= d. *)
Definition inside_by (d : R) (u w : vec) (M : mat) :=
  exists a b c e, 0 < a /\ 0 < b /\ 0 < c /\ 0 < e /\ d <= b * c /\
    M @ u = add (smul a u) (smul c w) /\ M @ w = add (smul b u) (smul e w).

Lemma act_smul M s v : M @ smul s v = smul s (M @ v).
Proof. apply vec_ext; coordinates; ring. Qed.

(** The product x y of a vector's coordinates x u + y w grows by 1 + 4 b c at least. *)
Lemma cone_step d M u w x y :
  cross u w <> 0 -> 0 <= d -> det M = 1 -> inside_by d u w M -> 0 < x -> 0 < y ->
  exists x' y', 0 < x' /\ 0 < y' /\ (1 + 4 * d) * (x * y) <= x' * y' /\
    M @ add (smul x u) (smul y w) = add (smul x' u) (smul y' w).
Proof.
  intros N D DM (a & b & c & e & A & B & C & F & BC & U & W) X Y.
  assert (Dt : a * e - b * c = 1).
  { assert (T : cross u w * det M = cross u w * (a * e - b * c)).
    { transitivity (cross (M @ u) (M @ w)); [coordinates; ring | rewrite U, W; coordinates; ring]. }
    apply Rmult_eq_reg_l in T; [lra | exact N]. }
  assert (XY : 0 < x * y) by nra.
  (* a c x^2 + b e y^2 >= 2 b c x y, since a c times the difference is (a c x - b c y)^2 and b c y^2 more *)
  assert (Z : 2 * (b * c) * (x * y) <= a * c * (x * x) + b * e * (y * y)).
  { apply Rmult_le_reg_l with (a * c); [nra|].
    assert (I : a * c * (a * c * (x * x) + b * e * (y * y)) - a * c * (2 * (b * c) * (x * y))
                = (a * c * x - b * c * y) * (a * c * x - b * c * y) + (b * c) * (y * y)).
    { replace (a * c * (b * e * (y * y))) with (b * c * (a * e) * (y * y)) by ring.
      transitivity (a * c * (a * c * (x * x)) + b * c * (1 + b * c) * (y * y) - a * c * (2 * (b * c) * (x * y)));
        [replace (1 + b * c) with (a * e) by lra; ring | ring]. }
    pose proof (Rle_0_sqr (a * c * x - b * c * y)) as Q; unfold Rsqr in Q.
    assert (0 <= (b * c) * (y * y)) by (apply Rmult_le_pos; nra). lra. }
  exists (a * x + b * y), (c * x + e * y).
  split; [nra|]; split; [nra|]; split.
  - assert (d * (x * y) <= b * c * (x * y)) by (apply Rmult_le_compat_r; lra).
    replace ((a * x + b * y) * (c * x + e * y)) with
      (a * c * (x * x) + b * e * (y * y) + (a * e) * (x * y) + b * c * (x * y)) by ring.
    replace (a * e) with (1 + b * c) by lra. lra.
  - rewrite act_combination, U, W; apply vec_ext; coordinates; ring.
Qed.

Theorem band_growth M u w d n :
  cross u w <> 0 -> 0 <= d ->
  (forall k, det (M k) = 1 /\ (inside_by d u w (M k) \/ inside_by d u w (opp (M k)))) ->
  forall x y, 0 < x -> 0 < y -> exists s x' y',
    (s = 1 \/ s = -1) /\ 0 < x' /\ 0 < y' /\ (1 + 4 * d) ^ n * (x * y) <= x' * y' /\
    Cone.product M n @ add (smul x u) (smul y w) = smul s (add (smul x' u) (smul y' w)).
Proof.
  intros N D H x y X Y; induction n as [|n (s & x' & y' & S & X' & Y' & G & E)]; simpl.
  - exists 1, x, y; split; [now left|]; split; [exact X|]; split; [exact Y|]; split; [lra|].
    apply vec_ext; coordinates; ring.
  - assert (Grown : forall z, (1 + 4 * d) * (x' * y') <= z -> (1 + 4 * d) * (1 + 4 * d) ^ n * (x * y) <= z).
    { intros z Z; apply Rle_trans with ((1 + 4 * d) * (x' * y')); [|exact Z].
      rewrite Rmult_assoc; apply Rmult_le_compat_l; lra. }
    destruct (H n) as [DM [I|I]].
    + destruct (cone_step d (M n) u w x' y') as (x2 & y2 & X2 & Y2 & G2 & E2); try assumption.
      exists s, x2, y2; split; [exact S|]; split; [exact X2|]; split; [exact Y2|]; split; [now apply Grown|].
      now rewrite act_mul, E, act_smul, E2.
    + destruct (cone_step d (opp (M n)) u w x' y') as (x2 & y2 & X2 & Y2 & G2 & E2); try assumption;
        [now rewrite det_opp|].
      exists (- s), x2, y2; split; [lra|]; split; [exact X2|]; split; [exact Y2|]; split; [now apply Grown|].
      rewrite act_mul, E, act_smul, <- E2; apply vec_ext; coordinates; simpl; ring.
Qed.

Lemma inside_product d u w M N :
  0 <= d -> cross u w <> 0 -> det M = 1 -> inside_by d u w M -> inside_by d u w N -> inside_by d u w (N ** M).
Proof.
  intros D C DM (a & b & c & e & A & B & G & F & BC & U & W) (a' & b' & c' & e' & A' & B' & G' & F' & BC' & U' & W').
  assert (Dt : a * e - b * c = 1).
  { assert (T : cross u w * det M = cross u w * (a * e - b * c)).
    { transitivity (cross (M @ u) (M @ w)); [coordinates; ring | rewrite U, W; coordinates; ring]. }
    apply Rmult_eq_reg_l in T; [lra | exact C]. }
  exists (a * a' + c * b'), (b * a' + e * b'), (a * c' + c * e'), (b * c' + e * e').
  assert (E : (b * a' + e * b') * (a * c' + c * e')
              = a * e * (b' * c') + b * a' * (a * c') + b * a' * (c * e') + e * b' * (c * e')) by ring.
  assert (P1 : 0 < b * a' * (a * c')) by (repeat apply Rmult_lt_0_compat; assumption).
  assert (P2 : 0 < b * a' * (c * e')) by (repeat apply Rmult_lt_0_compat; assumption).
  assert (P3 : 0 < e * b' * (c * e')) by (repeat apply Rmult_lt_0_compat; assumption).
  assert (P4 : 0 < b * c) by now apply Rmult_lt_0_compat.
  assert (P5 : d <= a * e * (b' * c')).
  { replace (a * e) with (1 + b * c) by lra; assert (0 <= b * c * (b' * c')) by nra; lra. }
  repeat split; try (apply Rplus_lt_0_compat; apply Rmult_lt_0_compat; assumption).
  - rewrite E; lra.
  - rewrite act_mul, U, act_combination, U', W'; apply vec_ext; coordinates; ring.
  - rewrite act_mul, W, act_combination, U', W'; apply vec_ext; coordinates; ring.
Qed.

(** A period is a product of returns: where all of them take one cone into its interior or into the opposite one, it is hyperbolic. *)
Theorem band_unstable M u w d n :
  cross u w <> 0 -> 0 <= d ->
  (forall k, det (M k) = 1 /\ (inside_by d u w (M k) \/ inside_by d u w (opp (M k)))) ->
  2 < Rabs (tr (Cone.product M (S n))) /\ exponential_growth (Cone.product M (S n)).
Proof.
  intros C D H.
  assert (Twice : forall A B, opp A ** B = opp (A ** B) /\ A ** opp B = opp (A ** B) /\ opp (opp A) = A).
  { intros A B; repeat split; matrix_ring. }
  assert (P : det (Cone.product M (S n)) = 1 /\
              (inside_by d u w (Cone.product M (S n)) \/ inside_by d u w (opp (Cone.product M (S n))))).
  { induction n as [|n [E I]].
    - destruct (H O) as [E I]; change (Cone.product M 1) with (M O ** one); rewrite mul_one_r; auto.
    - destruct (H (S n)) as [F J]; change (Cone.product M (S (S n))) with (M (S n) ** Cone.product M (S n)).
      set (Q := Cone.product M (S n)) in *; set (N := M (S n)) in *.
      split; [rewrite det_mul, E, F; ring|].
      destruct (Twice N Q) as (L & R & _).
      assert (EO : det (opp Q) = 1) by now rewrite det_opp.
      destruct I as [I|I], J as [J|J].
      + left; now apply inside_product.
      + right; rewrite <- L; now apply inside_product.
      + right; rewrite <- R; now apply inside_product.
      + left; replace (N ** Q) with (opp N ** opp Q); [now apply inside_product|].
        destruct (Twice N (opp Q)) as (L' & _ & _); rewrite L', R; apply (proj2 (proj2 (Twice (N ** Q) Q))). }
  destruct P as [E I]; apply (cone_hyperbolic _ u w E C).
  assert (In : forall Q, inside_by d u w Q -> inside u w (Q @ u) /\ inside u w (Q @ w)).
  { intros Q (a & b & c & e & A & B & G & F & _ & U & W); split.
    - exists a, c; auto.
    - exists b, e; auto. }
  destruct I as [I|I]; [left; now apply In|right].
  destruct (In _ I) as [A B].
  assert (Neg : forall v, smul (-1) (Cone.product M (S n) @ v) = opp (Cone.product M (S n)) @ v)
    by (intros; apply vec_ext; simpl; ring).
  now rewrite !Neg.
Qed.

(** In a frame that turns by an angle phi of the offset the products are the same, turned at both ends. *)
Lemma turning_along (T T' : R -> mat) a b kicked n x :
  (forall y, T' y ** T y = one) -> (forall y, T y ** T' y = one) ->
  along a b (fun y => T (turn a b y) ** kicked y ** T' y) n x
  = T (turns a b n x) ** along a b kicked n x ** T' x.
Proof.
  intros I J; revert x; induction n as [|n IH]; intros x; simpl.
  - now rewrite mul_one_r, J.
  - rewrite IH; rewrite <- !mul_assoc; f_equal; f_equal.
    rewrite !mul_assoc, I, mul_one_l; reflexivity.
Qed.
